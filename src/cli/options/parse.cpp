#include "cli/options/parse.h"

#include "cli/options/command_options.h"
#include "cli/options/environment.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <vector>

namespace penumbra::cli {

Parsed parse(int argc, const char* const* argv) {
    CLI::App program(
        "Renders glTF and OBJ models, exports them to POV-Ray and proves both pictures "
        "equal.",
        "penumbra");
    program.formatter(std::make_shared<HelpFormat>());
    program.set_help_flag("-h,--help", "Print this help and exit");
    program.set_version_flag("--version", "penumbra " PENUMBRA_VERSION,
                             "Print the version and exit");
    program.footer("Example:\n  penumbra render chair.glb -o chair.png\n\n"
                   "'penumbra COMMAND --help' lists the options of a command.");
    program.require_subcommand(1);

    std::array<Arguments, std::size(descriptions)> results;
    std::vector<std::unique_ptr<CommandOptions>> readers;
    for (std::size_t i = 0; i < results.size(); ++i)
        readers.push_back(std::make_unique<CommandOptions>(program, descriptions[i], results[i]));
    const auto chosen = [&] {
        return std::find_if(readers.begin(), readers.end(),
                            [](const auto& reader) { return reader->chosen(); });
    };
    try {
        program.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return {{}, without_double_gaps(program.help())};
    } catch (const CLI::CallForVersion& version) {
        return {{}, std::string(version.what()) + "\n"};
    } catch (const CLI::ParseError& error) {
        const auto reader = chosen();
        refuse(program, error,
               reader == readers.end() ? std::vector<std::string>{} : (*reader)->option_names());
    }

    const auto reader = chosen();
    Arguments& arguments = results[std::size_t(reader - readers.begin())];
    apply_environment(arguments);
    (*reader)->apply();
    (*reader)->finish();
    arguments.words = {"penumbra"};
    arguments.words.insert(arguments.words.end(), argv + 1, argv + argc);
    return {std::move(arguments), ""};
}

}  // namespace penumbra::cli
