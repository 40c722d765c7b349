// Defects of the picture as a whole: moved, turned, of other colours.
#include "defect_kinds.h"

#include <algorithm>
#include <cmath>

namespace defects {
namespace {

bool always(const Stage&) { return true; }

// The picture with `more` pixels in each row and column, as large as the others.
Image wider(const Stage& stage, int more) {
    NormalisedScene scene = stage.scene;
    RenderOptions options = stage.options;
    options.width += more;
    options.height += more;
    Camera& camera = scene.scene.cameras[scene.scene.camera];
    const double factor = camera.side == Camera::Side::horizontal
                              ? double(options.width) / stage.options.width
                              : double(options.height) / stage.options.height;
    camera.fov = 2 * std::atan(std::tan(camera.fov / 2) * factor);
    camera.extent *= factor;
    return render(scene, options);
}

Image cut(const Image& image, int left, int top, int width, int height) {
    Image result(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) result.at(x, y) = image.at(x + left, y + top);
    return result;
}

// A picture of one pixel more has its pixels' centres half a pixel off.
Image shifted_by_half(const Stage& stage) {
    return cut(wider(stage, 1), 1, 1, stage.options.width, stage.options.height);
}

Image shifted_by_one(const Stage& stage) {
    return cut(wider(stage, 2), 2, 1, stage.options.width, stage.options.height);
}

std::function<Image(const Stage&)> rearranged(bool across, bool along) {
    return [=](const Stage& stage) {
        Image result = stage.picture;
        for (int y = 0; y < result.height; ++y)
            for (int x = 0; x < result.width; ++x)
                result.at(x, y) = stage.picture.at(across ? result.width - 1 - x : x,
                                                   along ? result.height - 1 - y : y);
        return result;
    };
}

std::function<Image(const Stage&)> each_pixel(Color (*change)(const Color&)) {
    return [=](const Stage& stage) {
        Image result = stage.picture;
        for (Color& color : result.pixels) color = change(color);
        return result;
    };
}

Color each_channel(const Color& c, float (*change)(float)) {
    const auto shown = [&](float v) { return change(std::clamp(v, 0.F, 1.F)); };
    return {shown(c.x), shown(c.y), shown(c.z)};
}

Color exchanged(const Color& c) { return {c.z, c.y, c.x}; }
Color exposed(const Color& c) { return c * float(std::exp2(0.1)); }
Color darker(const Color& c) { return c * float(std::exp2(-0.05)); }
Color not_encoded(const Color& c) { return each_channel(c, srgb_to_linear); }
Color encoded_twice(const Color& c) { return each_channel(c, linear_to_srgb); }
Color by_power(const Color& c) {
    return each_channel(c, [](float v) { return srgb_to_linear(std::pow(v, 1 / 2.2F)); });
}

}  // namespace

std::vector<Defect> of_pictures() {
    return {{"shifted by half a pixel", {"shift"}, always, shifted_by_half},
            {"shifted by (0.3, -0.7) pixels",
             {"shift"},
             always,
             [](const Stage& stage) {
                 return Tracer(stage.scene).render(stage.options, {.dx = -0.3, .dy = 0.7});
             }},
            {"shifted by one pixel", {"shift"}, always, shifted_by_one},
            {"mirrored", {"mirror"}, always, rearranged(true, false)},
            {"upside down", {"flip"}, always, rearranged(false, true)},
            {"turned by 180 degrees", {"turn"}, always, rearranged(true, true)},
            {"red and blue exchanged", {"channels"}, always, each_pixel(exchanged)},
            {"exposure +0.1 EV", {"gain"}, always, each_pixel(exposed)},
            {"exposure -0.05 EV", {"gain"}, always, each_pixel(darker)},
            {"gamma 2.2 for sRGB", {"gamma_22"}, always, each_pixel(by_power)},
            // What one picture has too much the other lacks.
            {"sRGB encoding missing", {"double_srgb"}, always, each_pixel(not_encoded)},
            {"sRGB encoding doubled", {"no_srgb"}, always, each_pixel(encoded_twice)}};
}

}  // namespace defects
