#include "cli/batch/case_cache.h"

#include "base/file.h"

#include "penumbra/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace penumbra::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* file_name = "cache.json";

}  // namespace

void add_file(Hash& hash, const fs::path& file) {
    const std::string content = read_text(file);
    if (file.extension() != ".pov" && file.extension() != ".ini")
        return hash.add(std::string_view(content));
    // Comments name the command line, which may differ in what does not matter.
    std::string_view rest = content;
    while (!rest.empty()) {
        const auto end = std::min(rest.find('\n'), rest.size() - 1);
        const std::string_view line = rest.substr(0, end + 1);
        if (!line.starts_with("//") && !line.starts_with(";")) hash.add(line);
        rest.remove_prefix(end + 1);
    }
}

void add_folder(Hash& hash, const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::ranges::sort(files);
    for (const fs::path& file : files) {
        hash.add(std::string_view(file.lexically_relative(folder).native()));
        add_file(hash, file);
    }
}

std::optional<CachedCases> cached_cases(const fs::path& folder) {
    std::error_code ignored;
    if (!fs::exists(folder / file_name, ignored)) return std::nullopt;
    try {
        const Json json = Json::parse(read_text(folder / file_name));
        CachedCases cached = {
            .key = {json.at("pictures").get<std::string>(), json.at("verdict").get<std::string>()},
            .cases = cases_of_json(json.at("report").dump())};
        const auto logs = json.at("logs").get<std::vector<std::string>>();
        for (std::size_t i = 0; i < std::min(logs.size(), cached.cases.size()); ++i)
            cached.cases[i].povray_log = logs[i];
        return cached;
    } catch (const std::exception&) {
        return std::nullopt;  // of another version, or damaged: as if it were not there
    }
}

void store_cases(const fs::path& folder, const CachedCases& cached) {
    Json json;
    json["pictures"] = cached.key.pictures;
    json["verdict"] = cached.key.verdict;
    json["report"] = Json::parse(report_json(cached.cases));
    json["logs"] = Json::array();
    for (const Case& one : cached.cases) json["logs"].push_back(one.povray_log);
    write_file(folder / file_name,
               json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

const std::string& program_key() {
    static const std::string key = [] {
        Hash hash;
        hash.add(PENUMBRA_VERSION);
        add_file(hash, "/proc/self/exe");
        return text_of(hash.digest());
    }();
    return key;
}

}  // namespace penumbra::cli
