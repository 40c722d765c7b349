#include "cli/options/option_reader.h"

#include "base/text/suggest.h"
#include "cli/options/descriptions.h"

namespace penumbra::cli {

std::string without_double_gaps(std::string text) {
    for (auto at = text.find("\n\n\n"); at != std::string::npos; at = text.find("\n\n\n", at))
        text.erase(at, 1);
    return text;
}

void refuse(const CLI::App& program, const CLI::ParseError& error,
            const std::vector<std::string>& options) {
    const auto chosen = program.get_subcommands();
    const std::string see = fmt::format(" (see 'penumbra {}--help')",
                                        chosen.empty() ? "" : chosen[0]->get_name() + " ");
    const auto left = program.remaining(true);
    if (chosen.empty()) {
        std::vector<std::string> names;
        for (const Description& description : descriptions) names.emplace_back(description.name);
        if (left.empty()) throw Error(Failure::usage, "", "no command is given" + see);
        const char* const kind = left[0].starts_with('-') ? "option" : "command";
        throw Error(
            Failure::usage, "",
            fmt::format("unknown {} '{}'{}{}", kind, left[0], did_you_mean(left[0], names), see));
    }
    if (!left.empty()) {
        const std::string name = left[0].substr(0, left[0].find('='));
        throw Error(Failure::usage, "",
                    fmt::format("unknown option '{}'{}{}", name, did_you_mean(name, options), see));
    }
    std::string text = error.what();
    text = text.substr(0, text.find('\n'));
    throw Error(Failure::usage, "", text + see);
}

}  // namespace penumbra::cli
