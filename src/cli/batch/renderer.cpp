#include "cli/batch/renderer.h"

#include "base/memory.h"
#include "base/process.h"
#include "cli/advice.h"
#include "cli/options/values.h"

#include <fmt/format.h>

#include <cstring>
#include <system_error>

namespace penumbra::cli {
namespace {

namespace fs = std::filesystem;

void replace_all(std::string& text, const std::string& what, const std::string& by) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
}

// The extension that the command asks for with {out:exr}.
std::string extension_of(const OtherRenderer& renderer) {
    for (const std::string& word : renderer.words) {
        const auto at = word.find("{out:");
        const auto end = word.find('}', at == std::string::npos ? 0 : at);
        if (at != std::string::npos && end != std::string::npos)
            return word.substr(at + 5, end - at - 5);
    }
    return "png";
}

std::vector<std::string> filled(const OtherRenderer& renderer, const RendererInput& input,
                                const std::string& file, const std::string& extension) {
    std::vector<std::string> words;
    for (std::string word : renderer.words) {
        if (word == "{scene}") {
            for (const fs::path& path : input.scene) words.push_back(fs::absolute(path).string());
            continue;
        }
        const fs::path out = fs::absolute(input.folder / file);
        if (!input.scene.empty())
            replace_all(word, "{scene}", fs::absolute(input.scene.front()).string());
        replace_all(word, "{pov}", fs::absolute(input.pov).string());
        replace_all(word, "{out}", out.string());
        replace_all(word, "{out:" + extension + "}", out.string());
        replace_all(word, "{width}", std::to_string(input.width));
        replace_all(word, "{height}", std::to_string(input.height));
        words.push_back(std::move(word));
    }
    return words;
}

std::string last_line(const std::string& text) {
    const auto end = text.find_last_not_of(" \t\r\n");
    if (end == std::string::npos) return "";
    const auto begin = text.find_last_of('\n', end);
    const std::string line = text.substr(begin == std::string::npos ? 0 : begin + 1,
                                         end - (begin == std::string::npos ? 0 : begin + 1) + 1);
    return line.size() > 200 ? line.substr(0, 200) : line;
}

[[noreturn]] void fail(const OtherRenderer& renderer, const Finished& finished,
                       const RendererInput& input) {
    const std::string said = last_line(finished.output);
    const std::string why = said.empty() ? "" : fmt::format(": {}", said);
    const bool stopped =
        finished.how == Finished::How::stopped || finished.how == Finished::How::timed_out;
    if (finished.out_of_memory && !stopped)
        throw Error(Failure::povray, renderer.name,
                    fmt::format("needs more than the {} of memory that it may use (allow it more "
                                "with --max-memory){}",
                                memory_text(input.memory), why));
    switch (finished.how) {
    case Finished::How::stopped: throw Error(Failure::interrupted, "", "interrupted");
    case Finished::How::timed_out:
        throw Error(Failure::povray, renderer.name,
                    fmt::format("did not finish within {} s and was stopped (allow it more with "
                                "--timeout)",
                                input.timeout.count()));
    case Finished::How::signalled:
        throw Error(Failure::povray, renderer.name,
                    fmt::format("was ended by signal {} ({}){}", finished.code,
                                strsignal(finished.code), why));
    case Finished::How::exited: break;
    }
    throw Error(Failure::povray, renderer.name,
                fmt::format("ended with status {}{}", finished.code, why));
}

Image picture(const OtherRenderer& renderer, const fs::path& file, const RendererInput& input) {
    Image image;
    try {
        image = load_image(file);
    } catch (const Error& error) {
        throw Error(Failure::povray, renderer.name,
                    fmt::format("left no picture ({})", with_advice(error)));
    }
    if (image.width == input.width && image.height == input.height) return image;
    throw Error(Failure::povray, renderer.name,
                fmt::format("its picture has {}x{} pixels, not {}x{}", image.width, image.height,
                            input.width, input.height));
}

}  // namespace

OtherPicture run_renderer(const OtherRenderer& renderer, const RendererInput& input,
                          const Watch& watch) {
    const std::string extension = extension_of(renderer);
    OtherPicture result;
    result.file = fmt::format("{}.{}", renderer.name, extension);
    std::error_code ignored;
    fs::remove(input.folder / result.file, ignored);

    penumbra::Command command;
    command.argv = filled(renderer, input, result.file, extension);
    command.folder = fs::absolute(input.folder);
    command.timeout = input.timeout;
    command.memory = input.memory;
    command.stop = watch.stop;
    result.command = command.argv;
    const fs::path program = command.argv.empty() ? fs::path() : find_program(command.argv.front());
    if (program.empty())
        throw Error(Failure::povray, renderer.name,
                    fmt::format("its program '{}' is not found",
                                command.argv.empty() ? "" : command.argv.front()));
    command.argv.front() = fs::absolute(program).string();
    Finished finished;
    try {
        finished = run(command);
    } catch (const std::system_error& error) {
        throw Error(Failure::povray, renderer.name,
                    fmt::format("cannot be started: {}", error.code().message()));
    }
    result.log = finished.output;
    result.seconds = finished.seconds;
    if (finished.how != Finished::How::exited || finished.code != 0)
        fail(renderer, finished, input);
    result.image = picture(renderer, input.folder / result.file, input);
    return result;
}

}  // namespace penumbra::cli
