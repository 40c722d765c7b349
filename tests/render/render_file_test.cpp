// Rendering into a file, with interruptions.
#include "image/picture_writer.h"
#include "support/small_scenes.h"
#include "support/support.h"

#include "penumbra/render_file.h"
#include "penumbra/tracer.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <stop_token>
#include <vector>

namespace {

using namespace penumbra;
using test::TempDir;
namespace fs = std::filesystem;

NormalisedScene mirror_scene() {
    Scene scene = test::empty_scene();
    scene.materials[0].reflection = Color(0.4F);
    scene.materials[0].specular = 0.5F;
    scene.background = Color(0.1F, 0.2F, 0.5F);
    scene.spheres = {{.name = "a", .center = {-1, 0, 0}, .radius = 1.2, .material = 0},
                     {.name = "b", .center = {1.4, 0.5, 0}, .radius = 1, .material = 0}};
    scene.lights = {{.name = "sun", .position = {4, 8, 6}}};
    return test::as_is(std::move(scene));
}

constexpr RenderOptions small = {.width = 70, .height = 150};
const RenderFileOptions often = {.checkpoint_interval = 1e-9, .checkpoint_share = 1e9};

// Stops the rendering once that share is done.
RenderedFile interrupt_at(double share, const fs::path& file, RenderFileOptions options,
                          const NormalisedScene& scene) {
    std::stop_source source;
    const auto progress = [&](double done) {
        if (done >= share) source.request_stop();
    };
    // One thread takes the tiles in their order: no row waits for a tile that another has begun.
    RenderOptions in_order = small;
    in_order.threads = 1;
    return render_file(scene, in_order, file, options, {progress, source.get_token()});
}

// Leaves a checkpoint of about half a picture.
void leave_checkpoint(const fs::path& file, const NormalisedScene& scene) {
    CHECK(test::remedy_of([&] { interrupt_at(0.5, file, often, scene); }) == Remedy::resume);
    CHECK_FALSE(fs::exists(file));
    REQUIRE(fs::exists(file.string() + ".checkpoint"));
}

std::size_t entries(const fs::path& folder) {
    return std::size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("render_file, writes what render and save_image do") {
    const TempDir folder;
    const NormalisedScene scene = mirror_scene();
    const Image whole = render(scene, small);
    for (const char* name : {"a.png", "a.exr", "a.tif", "a.jpg", "a.hdr"}) {
        INFO(name);
        const std::string stem = name;
        save_image(folder / ("saved-" + stem), whole);
        const RenderedFile done = render_file(scene, small, folder / stem);
        CHECK(test::read(folder / stem) == test::read(folder / ("saved-" + stem)));
        CHECK(done.resumed_rows == 0);
        CHECK(done.warning.empty());
    }
    CHECK(entries(folder.path) == 10);
}

TEST_CASE("render_file, of no pixels is an error of usage and leaves no file") {
    const TempDir folder;
    const NormalisedScene scene = mirror_scene();
    const std::string message =
        test::message_of([&] { render_file(scene, {.width = 0, .height = 7}, folder / "a.png"); });
    CHECK(message == "a picture must have at least 1 x 1 pixels, not 0 x 7");
    CHECK(test::message_of([&] { metered_exposure(scene, {.width = 0}); }) ==
          "a picture must have at least 1 x 1 pixels, not 0 x 600");
    CHECK(entries(folder.path) == 0);
}

TEST_CASE("render_rows, gives the same rows from any band on") {
    const NormalisedScene scene = mirror_scene();
    const Image whole = render(scene, small);
    for (const int first : {0, render_band, 4 * render_band}) {
        int next = first;
        render_rows(scene, small, {first, small.height}, [&](int row, const Image& rows) {
            CHECK(row == next);
            next += rows.height;
            for (int y = 0; y < rows.height; ++y)
                for (int x = 0; x < rows.width; ++x) REQUIRE(rows.at(x, y) == whole.at(x, row + y));
        });
        CHECK(next == small.height);
    }
}

TEST_CASE("render_rows, takes whole bands of the picture alone") {
    const NormalisedScene scene = mirror_scene();
    const Tracer tracer(scene);
    RenderOptions options = small;
    options.height = 40;
    const auto rows_of = [&](int first, int last) {
        int count = 0;
        tracer.render_rows(options, {first, last},
                           [&](int, const Image& rows) { count += rows.height; });
        return count;
    };
    CHECK(rows_of(0, 40) == 40);
    CHECK(rows_of(0, 32) == 32);
    CHECK(rows_of(32, 40) == 8);
    for (const int row : {0, 32, 40}) CHECK(rows_of(row, row) == 0);
    for (const auto& [first, last] : {std::pair(5, 7), std::pair(-32, 0), std::pair(0, 640),
                                      std::pair(32, 0), std::pair(0, 39), std::pair(1, 32)})
        try {
            rows_of(first, last);
            FAIL_CHECK(first << " to " << last << " are taken");
        } catch (const Error& error) {
            CHECK(error.failure == Failure::usage);
            CHECK(error.what() ==
                  "the rows from " + std::to_string(first) + " to " + std::to_string(last) +
                      " are no range of a picture of 40 rows, or begin or end within a band of 32");
        }
}

TEST_CASE("render_rows, ends with what its receiver throws") {
    const NormalisedScene scene = mirror_scene();
    const auto full = [](int, const Image&) { throw Error(Failure::output, "disk", "is full"); };
    for (const int threads : {1, 2}) {
        RenderOptions options = small;
        options.threads = threads;
        CHECK(test::message_of([&] { render_rows(scene, options, {0, options.height}, full); }) ==
              "disk: is full");
    }
}

TEST_CASE("a resumed picture has the bytes of an undisturbed one") {
    const TempDir folder;
    const NormalisedScene scene = mirror_scene();
    for (const char* name : {"a.png", "a.exr", "a.jpg"}) {
        const fs::path file = folder / name, other = folder / ("undisturbed-" + std::string(name));
        render_file(scene, small, other);
        leave_checkpoint(file, scene);
        const RenderedFile done = render_file(scene, small, file, {.resume = true});
        CHECK(done.resumed_rows >= render_band);
        CHECK(done.warning.empty());
        CHECK(test::read(file) == test::read(other));
        CHECK_FALSE(fs::exists(file.string() + ".checkpoint"));
    }
}

TEST_CASE("what is damaged in a checkpoint is rendered again") {
    const TempDir folder;
    const NormalisedScene scene = mirror_scene();
    const fs::path file = folder / "a.png", checkpoint = folder / "a.png.checkpoint";
    render_file(scene, small, folder / "b.png");
    leave_checkpoint(file, scene);
    const std::string whole = test::read(checkpoint);
    const std::size_t band = std::size_t(small.width) * 3 * render_band;
    REQUIRE(whole.size() > band);

    const auto resumed_rows = [&](const std::string& content) {
        test::write(checkpoint, content);
        const RenderedFile done = render_file(scene, small, file, {.resume = true});
        CHECK(test::read(file) == test::read(folder / "b.png"));
        CHECK_FALSE(fs::exists(checkpoint));
        return done.resumed_rows;
    };
    const int all = resumed_rows(whole);
    CHECK(resumed_rows(whole + "the beginning of a piece") == all);
    CHECK(resumed_rows(whole.substr(0, whole.size() - 1)) < all);
    std::string changed = whole;
    changed[whole.size() - band / 2] = char(changed[whole.size() - band / 2] + 1);
    CHECK(resumed_rows(changed) < all);
    CHECK(resumed_rows("") == 0);
    CHECK(resumed_rows(whole.substr(0, 100)) == 0);
    CHECK(resumed_rows(whole.substr(0, whole.find('\n') + 1)) == 0);
}

TEST_CASE("rows that come faster than they can be kept are rendered again") {
    const TempDir folder;
    const NormalisedScene scene = mirror_scene();
    const RenderOptions large = {.width = 1100, .height = 3600, .threads = 1};
    const fs::path file = folder / "a.hdr";  // of 48 MB, more than what waits for a checkpoint
    std::stop_source source;
    const auto progress = [&](double done) {
        if (done >= 0.98) source.request_stop();
    };
    CHECK(test::remedy_of([&] {
              render_file(scene, large, file, {.checkpoint_interval = 1e-9, .checkpoint_share = 0},
                          {progress, source.get_token()});
          }) == Remedy::resume);
    const RenderedFile done = render_file(scene, large, file, {.resume = true});
    CHECK(done.resumed_rows >= render_band);
    CHECK(done.resumed_rows < 3000);
    render_file(scene, large, folder / "b.hdr");
    CHECK(test::read(file) == test::read(folder / "b.hdr"));
}

TEST_CASE("a resumed rendering that is interrupted again keeps what it began with") {
    const TempDir folder;
    const NormalisedScene scene = mirror_scene();
    const RenderOptions large = {.width = 1100, .height = 3600, .threads = 1};
    const fs::path file = folder / "a.hdr";
    const auto interrupt = [&](double share, const RenderFileOptions& options) {
        std::stop_source source;
        const auto progress = [&](double done) {
            if (done >= share) source.request_stop();
        };
        CHECK(test::remedy_of([&] {
                  render_file(scene, large, file, options, {progress, source.get_token()});
              }) == Remedy::resume);
    };
    interrupt(0.3, often);
    interrupt(0.9, {.checkpoint_interval = 1e-9, .checkpoint_share = 0, .resume = true});
    CHECK(render_file(scene, large, file, {.resume = true}).resumed_rows > 3000);
    render_file(scene, large, folder / "b.hdr");
    CHECK(test::read(file) == test::read(folder / "b.hdr"));
}

TEST_CASE("somebody else's file is no checkpoint") {
    const TempDir folder;
    test::write(folder / "a.png.checkpoint", "notes");
    render_file(mirror_scene(), small, folder / "a.png", {.resume = true});
    CHECK(test::read(folder / "a.png.checkpoint") == "notes");
    const RenderedFile done = render_file(mirror_scene(), small, folder / "a.png", often);
    CHECK(done.warning == "no checkpoint can be written beside the picture");
    CHECK(test::read(folder / "a.png.checkpoint") == "notes");
}

TEST_CASE("the checkpoint of another picture is an error that names the difference") {
    const TempDir folder;
    const fs::path file = folder / "a.png", checkpoint = folder / "a.png.checkpoint";
    const NormalisedScene scene = mirror_scene();
    const auto program = [] { return std::string("1"); };
    RenderFileOptions kept = often;
    kept.program = program;
    CHECK(test::remedy_of([&] { interrupt_at(0.5, file, kept, scene); }) == Remedy::resume);
    const std::string before = test::read(checkpoint);
    test::write(file, "an earlier picture");

    const auto difference = [&](const NormalisedScene& other, const RenderOptions& options,
                                const RenderFileOptions& chosen) {
        const auto work = [&] { render_file(other, options, file, chosen); };
        CHECK(test::remedy_of(work) == Remedy::restart);
        CHECK(test::read(checkpoint) == before);
        CHECK(test::read(file) == "an earlier picture");
        const std::string message = test::message_of(work);
        const std::string start = checkpoint.string() + ": is of another picture (";
        REQUIRE(message.starts_with(start));
        REQUIRE(message.ends_with(")"));
        return message.substr(start.size(), message.size() - start.size() - 1);
    };
    const RenderFileOptions resume = {.resume = true, .program = program};
    const auto with = [&](auto change) {
        RenderOptions options = small;
        change(options);
        return difference(scene, options, resume);
    };
    CHECK(with([](RenderOptions& o) { o.width = 71; }) == "size 70x150, now 71x150");
    CHECK(with([](RenderOptions& o) { o.samples = 3; }) == "samples 1, now 3");
    CHECK(with([](RenderOptions& o) { o.max_depth = 2, o.samples = 2; }) ==
          "samples 1, now 2; max_depth 5, now 2");
    CHECK(with([](RenderOptions& o) { o.antialiasing = Antialiasing(); }) ==
          "samples 1, now adaptive");
    CHECK(with([](RenderOptions& o) { o.exposure = 0.5; }) == "exposure 0, now 0.5");
    RenderFileOptions deep = resume;
    deep.save.bits = 16;
    CHECK(difference(scene, small, deep) == "bits per channel 8, now 16");
    RenderFileOptions newer = resume;
    newer.program = [] { return std::string("2"); };
    CHECK(difference(scene, small, newer) == "program version changed");

    const auto changed = [&](auto change) {
        NormalisedScene other = scene;
        change(other.scene);
        return difference(other, small, resume);
    };
    CHECK(changed([](Scene& s) { s.cameras[s.camera].position.x += 1; }) == "camera changed");
    CHECK(changed([](Scene& s) { s.lights[0].intensity = 2; }) == "lights changed");
    CHECK(changed([](Scene& s) { s.materials[0].diffuse = 0.1F; }) ==
          "materials or images changed");
    CHECK(changed([](Scene& s) { s.spheres[0].radius = 1.1; }) == "geometry changed");
    CHECK(changed([](Scene& s) { s.background = Color(1); }) ==
          "background or ambient light changed");
    CHECK(render_file(scene, small, file, resume).resumed_rows >= render_band);
}

TEST_CASE("a checkpoint of another picture is replaced when nothing is to be resumed") {
    const TempDir folder;
    const NormalisedScene scene = mirror_scene();
    NormalisedScene other = scene;
    other.scene.spheres[0].radius = 1.1;
    const fs::path file = folder / "a.png";
    leave_checkpoint(file, other);
    CHECK(render_file(scene, small, file).resumed_rows == 0);
    CHECK_FALSE(fs::exists(folder / "a.png.checkpoint"));
}

TEST_CASE("the checkpoint of another version is left alone") {
    const TempDir folder;
    const fs::path file = folder / "a.png", checkpoint = folder / "a.png.checkpoint";
    leave_checkpoint(file, mirror_scene());
    std::string earlier = test::read(checkpoint);
    earlier.replace(earlier.find("checkpoint 4"), 12, "checkpoint 3");
    test::write(checkpoint, earlier);
    CHECK(test::message_of([&] { render_file(mirror_scene(), small, file, {.resume = true}); }) ==
          checkpoint.string() + ": is of another picture (program version changed)");
    CHECK(test::read(checkpoint) == earlier);
}

TEST_CASE("a checkpoint that another run writes is not taken from it") {
    const TempDir folder;
    const fs::path file = folder / "a.png", checkpoint = folder / "a.png.checkpoint";
    leave_checkpoint(file, mirror_scene());
    const int other = ::open(checkpoint.c_str(), O_RDWR | O_CLOEXEC);
    REQUIRE(::flock(other, LOCK_EX) == 0);
    CHECK(test::message_of([&] { render_file(mirror_scene(), small, file, {.resume = true}); }) ==
          checkpoint.string() +
              ": is in use by another run, which renders the same file; wait for its end");
    ::close(other);
}

TEST_CASE("the progress of a resumed rendering counts what is rendered, from 0 to 1") {
    const TempDir folder;
    const NormalisedScene scene = mirror_scene();
    leave_checkpoint(folder / "a.png", scene);
    RenderOptions options = small;
    options.threads = 1;
    int resumed = 0;
    std::vector<double> told;
    const RenderFileOptions chosen = {.resume = true, .resumed = [&](int rows) { resumed = rows; }};
    const RenderedFile done = render_file(scene, options, folder / "a.png", chosen,
                                          {[&](double d) { told.push_back(d); }, {}});
    CHECK(resumed == done.resumed_rows);
    REQUIRE(resumed >= render_band);
    REQUIRE(told.size() > 2);
    CHECK(std::is_sorted(told.begin(), told.end()));
    CHECK(told.front() < 0.5);
    CHECK(told.back() == 1);
}

TEST_CASE("a short rendering leaves no checkpoint") {
    const TempDir folder;
    for (const RenderFileOptions& options : {RenderFileOptions{}, {.checkpoint_interval = 0}}) {
        const auto work = [&] { interrupt_at(0.5, folder / "a.png", options, mirror_scene()); };
        CHECK(test::message_of(work) == "interrupted");
        CHECK(test::remedy_of(work) == Remedy::none);
    }
    CHECK(entries(folder.path) == 0);
}

TEST_CASE("a picture larger than what is kept is written as it comes") {
    const TempDir folder;
    Image image(1500, 2500);  // 45 MB of floats
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = Color(float(i % 977) / 977, float(i % 251) / 251, float(i % 31));
    for (const char* name : {"a.exr", "a.png"}) {
        save_image(folder / name, image, {.bits = 16});
        const PictureFormat format =
            picture_format(folder / name, image.width, image.height, {.bits = 16});
        SampleWriter writer(folder / ("rows-" + std::string(name)), format.frame, format.srgb());
        std::vector<std::byte> samples;
        for (int y = 0; y < image.height; ++y) {
            samples.clear();
            append_samples({&image.at(0, y), std::size_t(image.width)}, format, samples);
            writer.append(samples);
        }
        writer.finish();
        CHECK(test::read(folder / name) == test::read(folder / ("rows-" + std::string(name))));
        const Image back = load_image(folder / name);
        CHECK(std::abs(back.at(700, 2499).x - image.at(700, 2499).x) < 1e-4F);
        CHECK(std::abs(back.at(3, 1700).y - image.at(3, 1700).y) < 1e-4F);
    }
}
