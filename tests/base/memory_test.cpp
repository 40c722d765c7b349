// What memory may be taken, by us and by what we run.
#include "base/memory.h"
#include "base/process.h"
#include "support/bombs.h"
#include "support/program.h"

#include "penumbra/importers.h"
#include "penumbra/limits.h"

#include <chrono>
#include <thread>

using namespace penumbra;
using test::contains;
using test::Ended;
using test::mega;
using test::message_of;
using test::sanitized;

TEST_CASE("claims add up until they are released") {
    set_memory_limit(std::size_t(1) << 40);
    const std::size_t half = std::size_t(1) << 39;
    {
        const MemoryClaim first(half, "a");
        CHECK(contains(message_of([&] { const MemoryClaim second(half, "here"); }),
                       "here: needs 512.0 GB of memory, more than the 51"));
        CHECK_FALSE(memory_is_left(half));
        MemoryClaim moved = MemoryClaim(half / 2, "b");
        moved = MemoryClaim();
        CHECK(memory_is_left(half / 2));
    }
    CHECK(memory_is_left(half));
    CHECK(times(half, half) == std::size_t(-1));
    CHECK(test::remedy_of([&] { const MemoryClaim more(4 * half, "here"); }) == Remedy::memory);
    set_memory_limit(0);
}

TEST_CASE("without a limit the library takes what it is asked for") {
    CHECK(memory_limit() == 0);
    CHECK(free_memory() > 64 * mega);
    const std::size_t petabyte = std::size_t(1) << 50;
    const MemoryClaim large(petabyte, "here"), larger(petabyte, "here");
    CHECK(memory_is_left(petabyte));
    // What no vector can hold is an Error all the same, and not a length_error.
    CHECK(contains(message_of([] { MemoryClaim(std::size_t(-1), "here"); }),
                   "here: needs 17179869184.0 GB of memory, more than the "));
}

TEST_CASE("the program names its option for the library's memory errors") {
    const test::TempDir folder;
    test::write(folder / "a.obj", "");
    std::filesystem::resize_file(folder / "a.obj", 200 * mega);
    CHECK(message_of([&] {
              set_memory_limit(100 * mega);
              read_obj(folder / "a.obj");
          }).find("--") == std::string::npos);
    set_memory_limit(0);
    const Ended ended = test::run(folder.path, {"info", "a.obj", "--max-memory", "100M"});
    CHECK(contains(ended.err, "penumbra: error: a.obj: needs 200 MB of memory, more than the "));
    CHECK(ended.err.ends_with(" that are left of 100 MB (raise it with --max-memory)\n"));
}

TEST_CASE("the program limits itself to three quarters of what is free") {
    // Of address space, which counts as free as far as there is less of it than of memory.
    const test::TempDir folder;
    test::write(folder / "a.obj", "");
    std::filesystem::resize_file(folder / "a.obj", 3000 * mega);
    const Finished finished = run(
        {.argv = {"/bin/sh", "-c", "ulimit -v 2097152; exec \"$0\" info a.obj", PENUMBRA_PROGRAM},
         .folder = folder.path});
    if (sanitized) return;
    CHECK(finished.code == 3);
    CHECK(contains(finished.output, " that are left of 1.5 GB (raise it with --max-memory)\n"));
}

TEST_CASE("many small claims are one large one") {
    std::vector<std::vector<char>> held;
    set_memory_limit(96 * mega);
    const auto take = [&] {
        for (int i = 0; i < 400; ++i) resize_claimed(held.emplace_back(), mega / 2, "here");
    };
    if (!sanitized) CHECK(contains(message_of(take), "here: needs "));
    set_memory_limit(0);
}

TEST_CASE("the limit can be given in words and by the environment") {
    const test::TempDir folder;
    test::write(folder / "a.obj", test::cube_corner);
    CHECK(test::run(folder.path, {"info", "a.obj", "--max-memory", "1.5g"}).status == 0);
    const Ended odd = test::run(folder.path, {"info", "a.obj", "--max-memory", "lots"});
    CHECK(odd.status == 2);
    CHECK(odd.err == "penumbra: error: --max-memory: 'lots' is not a size of 32M or more, such as "
                     "512M or 2G\n");
    CHECK(test::run(folder.path, {"info", "a.obj", "--max-memory", "1000"}).status == 2);
    test::write(folder / "b.obj", "");
    std::filesystem::resize_file(folder / "b.obj", 200 * mega);
    CHECK(test::run(folder.path, {"info", "b.obj"}, {{"PENUMBRA_MAX_MEMORY", "100M"}}).status == 3);
    CHECK(test::run(folder.path, {"info", "a.obj"}, {{"PENUMBRA_MAX_MEMORY", "x"}}).status == 2);
}

TEST_CASE("a program that is run has a limit of its own") {
    const Command greedy = {
        .argv = {"/bin/sh", "-c", "head -c 600000000 /dev/zero | tail -n 1 > /dev/null"},
        .memory = 64 * mega};
    const Finished finished = run(greedy);
    INFO(finished.output);
    CHECK(finished.code != 0);
    CHECK(finished.out_of_memory);
    const Finished modest = run({.argv = {"/bin/sh", "-c", "exit 3"}, .memory = 64 * mega});
    CHECK(modest.code == 3);
    CHECK_FALSE(modest.out_of_memory);
    const Finished limits = run(
        {.argv = {"/bin/sh", "-c", "ulimit -t; ulimit -d"}, .timeout = std::chrono::seconds(99)});
    CHECK(limits.output == std::to_string(100 * sysconf(_SC_NPROCESSORS_ONLN)) + "\nunlimited\n");
}

TEST_CASE("POV-Ray does not outlive a penumbra that is killed") {
    const test::TempDir folder;
    test::write(folder / "a.toml", test::small_scene);
    const auto povray =
        test::write(folder / "fake", "#!/bin/sh\n"
                                     "[ \"$1\" = --version ] && echo POV-Ray 3.7 && exit\n"
                                     "echo $$ > pid.new\nmv pid.new ../pid || mv "
                                     "pid.new pid\nexec sleep 60\n");
    test::fs::permissions(povray, test::fs::perms::owner_all);
    const test::Running running(
        folder.path, {"validate", "a.toml", "--report", "report", "--povray", povray.string()});
    test::fs::path file;
    for (int i = 0; i < 1000 && file.empty(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        for (const auto& entry : test::fs::recursive_directory_iterator(
                 folder.path, test::fs::directory_options::skip_permission_denied))
            if (entry.path().filename() == "pid") file = entry.path();
    }
    REQUIRE_FALSE(file.empty());
    const pid_t child = std::stoi(test::read(file));
    REQUIRE(kill(child, 0) == 0);
    kill(running.pid, SIGKILL);
    waitpid(running.pid, nullptr, 0);
    for (int i = 0; i < 300 && kill(child, 0) == 0; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    CHECK(kill(child, 0) != 0);
}
