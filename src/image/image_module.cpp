#include "image/image_module.h"

#include "base/module.h"

#include "penumbra/image_module.h"

#include <mutex>
#include <thread>

namespace penumbra {
namespace {

std::jthread loader;

}  // namespace

const ImageModule& image_module() {
    static const ImageModule& module = *static_cast<const ImageModule*>(
        load_module({"image", "penumbra-imageio.so", image_module_entry, image_module_abi}));
    return module;
}

void preload_image_module() {
    static std::once_flag once;
    std::call_once(once, [] {
        loader = std::jthread([] {
            try {
                image_module();
            } catch (...) {  // whoever needs the module will try again and say so
            }
        });
    });
}

void wait_for_image_module() {
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    if (loader.joinable()) loader.join();
}

}  // namespace penumbra
