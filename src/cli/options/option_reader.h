// The options of one subcommand: how they are declared to CLI11 and applied.
#pragma once

#include "cli/options/values.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace penumbra::cli {

// As CLI11's, but without "..." behind every type.
struct HelpFormat : CLI::Formatter {
    std::string make_option_opts(const CLI::Option* option) const override {
        const std::string type = option->get_type_name();
        return type.empty() || option->get_positional() ? "" : " " + type;
    }
};

/// One subcommand with the options that were declared for it. Values are applied in the order of
/// the command line, for a later setting overrides an earlier one.
class OptionReader {
  public:
    using Apply = std::function<void(const std::string&)>;

    OptionReader(CLI::App& program, const char* name, const char* what)
        : app(program.add_subcommand(name, what)) {
        app->set_help_flag("-h,--help", "Print this help and exit");
    }

    bool chosen() const { return app->parsed(); }

    void apply() {
        std::map<const CLI::Option*, std::size_t> seen;
        for (const CLI::Option* option : app->parse_order()) {
            const auto found = appliers_.find(option);
            if (found == appliers_.end()) continue;
            found->second(option->results().at(seen[option]++));
        }
    }

    std::vector<std::string> option_names() const {
        std::vector<std::string> names;
        for (const CLI::Option* option : app->get_options())
            for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        return names;
    }

  protected:
    CLI::App* app;
    std::string group;  ///< of the options that are declared next

    /// Words that belong to no option.
    void positional(const std::string& name, const std::string& what, Apply apply) {
        values_.push_back(std::make_unique<std::vector<std::string>>());
        CLI::Option* const option = app->add_option(name, *values_.back(), what);
        option->type_name("");
        appliers_[option] = std::move(apply);
    }

    void value(const std::string& name, const std::string& type, const std::string& what,
               Apply apply) {
        values_.push_back(std::make_unique<std::vector<std::string>>());
        CLI::Option* const option = app->add_option(name, *values_.back(), what);
        option->allow_extra_args(false)->type_name(type)->group(group);
        appliers_[option] = std::move(apply);
    }

    void flag(const std::string& name, bool& target, const std::string& what) {
        app->add_flag(name, target, what)->group(group);
    }

    // One of the values of an enumeration, by `words` in its order.
    template <class Enum>
    void choice(const std::string& name, const std::vector<std::string>& words,
                const std::string& what, Enum& target) {
        value(name, fmt::format("{}", fmt::join(words, "|")), what,
              [name, words, &target](const std::string& text) {
                  target = Enum(read_choice(name, text, words));
              });
    }

  private:
    std::map<const CLI::Option*, Apply> appliers_;
    std::vector<std::unique_ptr<std::vector<std::string>>> values_;
};

/// `text` without two blank lines in a row.
std::string without_double_gaps(std::string text);

/// Throws CLI11's own findings as one clear sentence; `options` are those of the chosen command.
[[noreturn]] void refuse(const CLI::App& program, const CLI::ParseError& error,
                         const std::vector<std::string>& options);

}  // namespace penumbra::cli
