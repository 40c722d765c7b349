// Parts of penumbra that are shared libraries of their own, loaded when they are first needed.
#pragma once

namespace penumbra {

struct ModuleFile {
    const char* what;   ///< for messages: "image"
    const char* file;   ///< "penumbra-imageio.so"
    const char* entry;  ///< its one symbol, of type const Table*()
    int abi;            ///< what the Table's first member, an int, must be
};

/// The Table of a module's functions. Throws std::runtime_error with the reason.
const void* load_module(const ModuleFile& module);

}  // namespace penumbra
