// penumbra-to-tachyon SCENE... OUT.dat [--set KEY=VALUE]: the scene as Tachyon reads it.
#include "arguments.h"
#include "tachyon_writer.h"

#include <cstdio>

int main(int count, char** words) try {
    using namespace penumbra;
    const bench::Arguments arguments = bench::parse(count, words);
    if (arguments.names.size() < 2)
        throw Error(Failure::usage, "",
                    "usage: penumbra-to-tachyon SCENE... OUT.dat [--set KEY=VALUE]");
    Imported imported =
        load_scene({arguments.names.begin(), arguments.names.end() - 1}, arguments.load);
    const NormalisedScene scene = normalise(std::move(imported.scene), imported.render);
    for (const Loss& loss : bench::write_tachyon(scene, imported.render, arguments.names.back()))
        std::fprintf(stderr, "penumbra-to-tachyon: %s: %s\n", loss.place.c_str(),
                     loss.what.c_str());
    return 0;
} catch (const penumbra::Error& error) {
    std::fprintf(stderr, "penumbra-to-tachyon: %s\n", error.what());
    return 1;
}
