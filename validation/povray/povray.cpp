// Runs POV-Ray and reads its pixels.
#include "penumbra/povray.h"

#include "base/descriptor.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/process.h"
#include "base/text/ascii.h"
#include "base/text/text.h"
#include "validation/povray/render_state.h"

#include "penumbra/limits.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

fs::path povray_program(const PovrayOptions& options) {
    const char* const variable = std::getenv("PENUMBRA_POVRAY");
    std::string name = options.binary;
    if (name.empty() && variable) name = variable;
    if (name.empty()) name = "povray";
    const fs::path program = find_program(name);
    if (program.empty()) throw Error(Failure::povray, name, "not found", Remedy::program);
    return program;
}

Finished start(const Command& command) {
    try {
        return run(command);
    } catch (const std::system_error& error) {
        throw Error(Failure::povray, command.argv[0],
                    "cannot be started: " + error.code().message());
    }
}

// ---- the .ini ---------------------------------------------------------------------------------

constexpr std::string_view blanks = " \t\r";

// The value of an option, whose names POV-Ray takes in any case; the last one counts.
std::string ini_value(const std::string& ini, const std::string& option) {
    std::istringstream lines(ini);
    std::string result;
    for (std::string line; std::getline(lines, line);) {
        const auto equals = line.find('=');
        if (equals == std::string::npos) continue;
        const std::string_view whole = line;
        if (lower_case(trimmed(whole.substr(0, equals), blanks)) != option) continue;
        result = trimmed(whole.substr(equals + 1), blanks);
        if (result.size() > 1 && (result[0] == '"' || result[0] == '\''))
            result = result.substr(1, result.find(result[0], 1) - 1);
    }
    return result;
}

fs::path output_file(const fs::path& ini) {
    std::string text;
    try {
        text = read_text(ini);
    } catch (const Error& error) {
        throw Error(Failure::povray, "", error.what(), error.remedy);
    }
    const std::string name = ini_value(text, "output_file_name");
    if (name.empty())
        throw Error(Failure::povray, ini.string(),
                    "has no Output_File_Name that says where the "
                    "picture is");
    return fs::absolute(ini).parent_path() / name;
}

// POV-Ray splits its arguments again, by rules of its own. A file whose name would not survive is
// run under another one, which goes away with this object.
class PlainName {
  public:
    explicit PlainName(const fs::path& ini) : name(ini.filename().string()) {
        const auto plain = [](char c) { return is_letter_or_digit(c) || c == '.' || c == '_'; };
        if (std::ranges::all_of(name, plain)) return;
        static std::atomic<int> count = 0;
        name = fmt::format("penumbra_{}_{}.ini", getpid(), ++count);
        alias_ = fs::absolute(ini).parent_path() / name;
        std::error_code error;
        if (!fs::copy_file(ini, alias_, error))
            throw Error(Failure::output, alias_.string(), "cannot write: " + error.message());
    }
    ~PlainName() {
        std::error_code ignored;
        if (!alias_.empty()) fs::remove(alias_, ignored);
    }
    PlainName(const PlainName&) = delete;
    PlainName& operator=(const PlainName&) = delete;

    std::string name;

  private:
    fs::path alias_;
};

// ---- the render-state file --------------------------------------------------------------------

// POV-Ray truncates the file if it is there, fills it and unlinks it at the end. Opened before, it
// can be read after that, and nothing is left behind however POV-Ray ends.
class StateFile {
  public:
    explicit StateFile(fs::path file) : path_(std::move(file)) {
        remove();
        descriptor_ = Descriptor(open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
        if (!descriptor_)
            throw Error(Failure::output, path_.string(),
                        "cannot write: " + std::generic_category().message(errno));
    }
    ~StateFile() { remove(); }
    StateFile(const StateFile&) = delete;
    StateFile& operator=(const StateFile&) = delete;

    std::size_t size() const {
        struct stat status{};
        return fstat(descriptor_.get(), &status) == 0 ? std::size_t(status.st_size) : 0;
    }

    std::vector<std::byte> content() const {
        std::vector<std::byte> result(size());
        std::size_t done = 0;
        while (done < result.size()) {
            const ssize_t n =
                pread(descriptor_.get(), result.data() + done, result.size() - done, off_t(done));
            if (n < 0 && errno == EINTR) continue;
            if (n <= 0) break;
            done += std::size_t(n);
        }
        result.resize(done);
        return result;
    }

  private:
    void remove() const {
        std::error_code ignored;
        fs::remove(path_, ignored);
    }

    fs::path path_;
    Descriptor descriptor_;
};

// ---- what POV-Ray printed ---------------------------------------------------------------------

// Progress is printed as lines that overwrite each other; only the last of them stays. Control
// characters that a terminal would obey are dropped.
std::string readable(const std::string& output) {
    std::istringstream lines(output);
    std::string result;
    for (std::string line; std::getline(lines, line);) {
        while (!line.empty() && line.back() == '\r') line.pop_back();
        line.erase(0, line.rfind('\r') + 1);
        std::erase_if(line, [](unsigned char c) { return (c < ' ' && c != '\t') || c == 127; });
        result += line + '\n';
    }
    return result;
}

// POV-Ray breaks its messages at 80 columns: at a space, which then starts the next line, or
// anywhere if there is none.
std::vector<std::string> messages(const std::string& log) {
    std::istringstream lines(log);
    std::vector<std::string> result;
    bool full = false;
    for (std::string line; std::getline(lines, line);) {
        const bool goes_on = !result.empty() && (full || line.starts_with(' '));
        full = line.size() >= 80;
        if (goes_on)
            result.back() += line;
        else
            result.push_back(line);
    }
    return result;
}

// What POV-Ray says when its own thread does not start as soon as it expects, which happens on a
// busy machine; nothing has been rendered then.
constexpr std::string_view no_thread = "Timed out waiting for worker thread startup";
constexpr int most_starts = 5;

// One of POV-Ray's error messages: "File 'a.pov' line 3: Parse Error: text", the same without a
// place, or one sentence from outside the parser.
struct Complaint {
    std::string file = {}, line = {}, text = {};
    int weight = 0;  // the heaviest tells most; 0: not an error
};

Complaint complaint(const std::string& message) {
    constexpr std::string_view parse_error = "Parse Error: ";
    const auto starts = [&](std::string_view text) { return message.starts_with(text); };
    const auto colon = message.find(parse_error);
    if (colon == std::string::npos) {
        const bool outside = starts("Cannot ") || starts("Could not ") || starts("Failed to ") ||
                             starts("Unable to ") || starts("Fatal error") ||
                             starts("Out of memory") || starts(no_thread);
        return {"", "", message, outside ? 1 : 0};
    }
    Complaint result = {"", "", message.substr(colon + parse_error.size()), 2};
    // What is only "possibly" an error is a warning, except that without its file a parser stops.
    const bool possible = message.find("Possible Parse Error") < colon;
    if (possible && !result.text.starts_with("Cannot find file")) return {};
    const auto quote = message.rfind("' line ", colon);
    if (starts("File '") && quote != std::string::npos) {
        result.file = message.substr(6, quote - 6);
        const auto digits = quote + 7;
        result.line = message.substr(digits, message.find(':', digits) - digits);
        result.weight = 3;
    }
    return result;
}

// Where and what POV-Ray's first error is, in its own words.
Error first_error(const std::string& log, int status, const fs::path& ini) {
    Complaint worst;
    for (const std::string& message : messages(log)) {
        Complaint found = complaint(message);
        // A missing file is said twice, the first time with its name.
        const bool repeated = found.text == "Cannot open input file." && worst.weight > 1;
        if (found.weight > worst.weight && !repeated) worst = std::move(found);
    }
    if (worst.weight == 0)
        return {Failure::povray, ini.string(),
                fmt::format("POV-Ray failed with status {} and did not say why", status)};
    std::string place = ini.string();
    if (!worst.file.empty()) place = (ini.parent_path() / worst.file).string() + ":" + worst.line;
    while (worst.text.ends_with('.')) worst.text.pop_back();
    return {Failure::povray, place, "POV-Ray: " + worst.text};
}

bool has_no_thread(const Finished& finished) {
    return finished.how == Finished::How::exited && finished.code != 0 &&
           finished.output.find(no_thread) != std::string::npos;
}

[[noreturn]] void fail(const Finished& finished, const std::string& log, const fs::path& ini,
                       const Command& command) {
    const bool stopped =
        finished.how == Finished::How::stopped || finished.how == Finished::How::timed_out;
    if (finished.out_of_memory && !stopped)
        throw Error(Failure::povray, ini.string(),
                    fmt::format("POV-Ray needs more than the {} of memory that it may use",
                                memory_text(command.memory)),
                    Remedy::memory);
    switch (finished.how) {
    case Finished::How::stopped: throw Error(Failure::interrupted, "", "interrupted");
    case Finished::How::timed_out:
        throw Error(Failure::povray, ini.string(),
                    fmt::format("POV-Ray did not finish within {} s and was stopped",
                                double(command.timeout.count()) / 1000),
                    Remedy::time);
    case Finished::How::signalled:
        throw Error(Failure::povray, ini.string(),
                    fmt::format("POV-Ray was ended by signal {} ({})", finished.code,
                                strsignal(finished.code)));
    case Finished::How::exited: break;
    }
    throw first_error(log, finished.code, ini);
}

Image pixels(const StateFile& state, const fs::path& picture, const fs::path& ini, int width,
             int height) {
    if (auto image = decode_render_state(state.content(), width, height)) return *std::move(image);
    Image image;
    try {
        image = load_image(picture);
    } catch (const Error& error) {
        throw Error(Failure::povray, ini.string(),
                    fmt::format("POV-Ray left no picture ({})", error.what()), error.remedy);
    }
    if (image.width != width || image.height != height)
        throw Error(Failure::povray, ini.string(),
                    fmt::format("POV-Ray's picture has {}x{} pixels, not {}x{}", image.width,
                                image.height, width, height));
    return image;
}

}  // namespace

PovrayRun run_povray(const fs::path& ini, int width, int height, const PovrayOptions& options,
                     const Watch& watch) {
    const fs::path program = povray_program(options);
    const fs::path picture = output_file(ini);
    const PlainName name(ini);
    const StateFile state(fs::path(picture).replace_extension(".pov-state"));
    std::error_code ignored;
    fs::remove(picture, ignored);  // so that what is there afterwards is of this run

    Command command;
    command.argv = {program.string(), name.name};
    if (options.threads > 0) command.argv.push_back(fmt::format("+WT{}", options.threads));
    command.folder = fs::absolute(ini).parent_path();
    // A .povray/3.7/povray.ini of the user's would change the picture. And where POV-Ray restricts
    // its file access, what lies below the home folder may be read: textures.
    command.environment = {{"HOME", command.folder.string()}, {"POVINI", ""}};
    command.timeout = options.timeout;
    command.memory = options.memory > 0 ? options.memory : memory_limit();
    command.stop = watch.stop;
    const double full = render_state_size(width, height);
    if (watch.progress)
        command.poll = [&] { watch.progress(std::min(double(state.size()) / full, 1.0)); };

    Finished finished = start(command);
    for (int starts = 1; starts < most_starts && has_no_thread(finished); ++starts)
        finished = start(command);
    PovrayRun result;
    result.log = readable(finished.output);
    try {
        if (finished.how != Finished::How::exited || finished.code != 0)
            fail(finished, result.log, ini, command);
        result.image = pixels(state, picture, ini, width, height);
    } catch (...) {
        fs::remove(picture, ignored);
        throw;
    }
    if (!options.keep_exr) fs::remove(picture, ignored);
    if (watch.progress) watch.progress(1);
    result.command = {program.string(), ini.filename().string()};
    result.command.insert(result.command.end(), command.argv.begin() + 2, command.argv.end());
    result.folder = command.folder;
    result.seconds = finished.seconds;
    result.cpu_seconds = finished.cpu_seconds;
    return result;
}

std::string povray_version(const PovrayOptions& options) {
    Command command;
    command.argv = {povray_program(options).string(), "--version"};
    command.timeout = std::chrono::seconds(10);
    std::istringstream lines(readable(start(command).output));
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("POV-Ray ")) return std::string(trimmed(line, blanks));
    throw Error(Failure::povray, command.argv[0], "does not tell a version of POV-Ray");
}

}  // namespace penumbra
