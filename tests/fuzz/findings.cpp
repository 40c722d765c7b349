#include "fuzz.h"

#include <cxxabi.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>
#include <typeinfo>

namespace fuzz {
namespace {

std::string type_name(const std::type_info& type) {
    int status = 0;
    const std::unique_ptr<char, void (*)(void*)> name(
        abi::__cxa_demangle(type.name(), nullptr, nullptr, &status), std::free);
    return name ? name.get() : type.name();
}

}  // namespace

void finding(const std::string& what) {
    std::fprintf(stderr, "FINDING: %s\n", what.c_str());
    std::abort();
}

bool may_refuse(const std::function<void()>& work) {
    using penumbra::Error;
    using penumbra::Failure;
    try {
        work();
        return true;
    } catch (const Error& error) {
        check_presentable(error.what(), "an error message");
        if (error.failure != Failure::input && error.failure != Failure::usage)
            finding(std::string("an input causes a failure that is not its own: ") + error.what());
    } catch (const std::bad_alloc&) {
        if (!memory_cap_reached()) finding("std::bad_alloc below the memory cap");
    } catch (const std::exception& error) {
        finding(type_name(typeid(error)) + ": " + error.what());
    } catch (...) {
        finding("something is thrown that is no exception");
    }
    return false;
}

void check_presentable(std::string_view text, const char* what) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        // U+0080 to U+009F, the second set of control characters, which terminals obey too.
        const bool second_set = c == 0xc2 && i + 1 < text.size() &&
                                static_cast<unsigned char>(text[i + 1]) >= 0x80 &&
                                static_cast<unsigned char>(text[i + 1]) < 0xa0;
        if (c < 0x20 || c == 0x7f || second_set)
            finding(std::string(what) + " has control characters: " + std::string(text));
    }
}

}  // namespace fuzz
