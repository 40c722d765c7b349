#include <penumbra/exporters.h>
#include <penumbra/importers.h>
#include <penumbra/tracer.h>

#include <iostream>

int main(int, char** argv) try {
    penumbra::Imported model = penumbra::load_scene({argv[1]});
    model.render.width = 32;
    model.render.height = 24;
    const penumbra::NormalisedScene scene = penumbra::normalise(model.scene, model.render);
    const penumbra::Image picture = penumbra::render(scene, model.render);
    penumbra::save_image("picture.png", picture);
    penumbra::write_pov(scene, model.render, "picture.pov");
    std::cout << "green in the middle: " << picture.at(16, 12).y << '\n';
} catch (const penumbra::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
