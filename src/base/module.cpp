#include "base/module.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

// Adds the places around `binary`, the file that holds our code: beside it (a build tree, a
// plugin's folder) and where `cmake --install` puts the module, wherever the whole installation was
// moved. In a build tree the program is one folder above its tests.
void add_places(std::vector<fs::path>& places, const fs::path& binary) {
    const fs::path folder = binary.parent_path();
    places.push_back(folder);
    places.push_back(folder / "penumbra");
    places.push_back(folder / "lib" / "penumbra");
    places.push_back(folder.parent_path() / PENUMBRA_MODULE_SUBDIR);
    places.push_back(folder.parent_path() / "lib" / "penumbra");
}

// Where to look, in order.
std::vector<fs::path> module_places() {
    std::vector<fs::path> places;
    if (const char* given = std::getenv("PENUMBRA_MODULE_DIR"); given && *given) return {given};

    // In a shared library that was linked with us dladdr knows the file; of a program it only knows
    // how the user called it.
    std::error_code error;
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void*>(&module_places), &info) != 0 && info.dli_fname) {
        const fs::path library = fs::canonical(info.dli_fname, error);
        if (!error && std::string_view(info.dli_fname).find('/') != std::string_view::npos)
            add_places(places, library);
    }
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (!error) add_places(places, program);
#ifdef PENUMBRA_BUILD_MODULE_DIR
    places.emplace_back(PENUMBRA_BUILD_MODULE_DIR);
#endif
    // A program of somebody else's, with the static library in it, may lie anywhere.
    places.emplace_back(PENUMBRA_MODULE_DIR);
    return places;
}

}  // namespace

const void* load_module(const ModuleFile& module) {
    std::string problem = std::string("there is no ") + module.file;
    for (const fs::path& place : module_places()) {
        const fs::path file = place / module.file;
        std::error_code ignored;
        if (!fs::exists(file, ignored)) continue;
        // Lazy: of the 60,000 symbols of OpenImageIO's 260 libraries only few are ever used.
        void* const handle = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
        if (handle == nullptr) {
            problem = dlerror();
            continue;
        }
        const auto entry = reinterpret_cast<const void* (*)()>(dlsym(handle, module.entry));
        const void* const table = entry == nullptr ? nullptr : entry();
        if (table != nullptr && *static_cast<const int*>(table) == module.abi) return table;
        problem = file.string() + " is of another version of penumbra";
    }
    throw std::runtime_error(std::string("the ") + module.what + " module cannot be loaded: " +
                             problem + " (PENUMBRA_MODULE_DIR names its folder)");
}

}  // namespace penumbra
