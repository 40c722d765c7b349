// Scene -> Image, by recursive ray tracing.
#pragma once

#include "penumbra/image.h"
#include "penumbra/prepare.h"
#include "penumbra/render_options.h"
#include "penumbra/watch.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace penumbra {

/// The rows of a picture from number `first` on.
using TakeRows = std::function<void(int first, const Image& rows)>;

/// Pictures are rendered in bands of so many rows, whatever is done with them.
inline constexpr int render_band = 32;

/// [first, last) of a picture's rows, first <= last: multiples of render_band, or the picture's
/// end.
struct RowRange {
    int first = 0, last = 0;
};

/// A picture as the scene does not ask for it.
struct Overrides {
    /// In the scene's place, in the units of NormalisedScene. Precondition: defects() would find
    /// nothing in it.
    std::optional<Camera> camera = {};
    bool shadows = true;    ///< else nothing hides a source
    bool penumbrae = true;  ///< else every light is one source
    double dx = 0, dy = 0;  ///< pixels by which every ray starts more to the right and further down
};

/// A scene made ready for tracing once and rendered any number of times, with other cameras, sizes,
/// samples and rows. The same input gives the same bytes for any number of threads, and whatever
/// was rendered or changed before.
///
///     NormalisedScene scene = normalise(std::move(imported.scene), options);
///     Tracer tracer(scene);
///     save_image("front.png", tracer.render(options));
///     scene.scene.lights[0].intensity *= 2;
///     tracer.update(scene);
///     save_image("brighter.png", tracer.render(options, {.camera = side}));
///
/// Its const functions may be called from several threads at once.
class Tracer {
  public:
    /// Refers to `scene`, which must outlive it and may be changed only if update() is called
    /// before anything else. `threads`: for this and for update(); 0: as many as the machine has.
    /// `instances_move`: every large mesh has an acceleration structure of its own, so that moving
    /// one costs next to nothing; rays take a little longer. Otherwise only meshes that several
    /// instances show have one, and the others are built again with all that moves. Precondition:
    /// defects(scene.scene).empty(). Throws Error (input) where the acceleration structures would
    /// take more than memory_limit(), or Embree cannot build them.
    explicit Tracer(const NormalisedScene& scene, int threads = 0, bool instances_move = false);
    /// Nothing would be left to refer to.
    explicit Tracer(NormalisedScene&& scene, int threads = 0, bool instances_move = false) = delete;
    Tracer(Tracer&& other) noexcept;
    Tracer& operator=(Tracer&& other) noexcept;
    ~Tracer();

    /// Takes `scene` in the place of the one before, and prepares what differs: cameras, lights,
    /// materials and textures need no acceleration structure; a moved, added or removed instance,
    /// or one that begins or ceases to be translucent, a new one over all instances; a mesh with
    /// other positions or facets its own. Contents are compared, so the scene may be the same
    /// object or another one. Precondition and errors are those of the constructor; after an error
    /// only update() and the destructor may be called.
    void update(const NormalisedScene& scene);
    void update(NormalisedScene&& scene) = delete;

    /// The scene as its active camera sees it, with POV-Ray 3.7's light model and tolerances.
    /// options.exposure is folded into the scene already. Throws Error (interrupted; usage where
    /// the options make no picture).
    Image render(const RenderOptions& options, const Overrides& overrides = {},
                 const Watch& watch = {}) const;

    /// Some rows of the same picture, without it ever being in memory as a whole: calls `take` for
    /// finished bands from the top, one at a time, on any thread. What it throws ends the
    /// rendering. Throws Error (interrupted; usage where the options make no picture or `rows` are
    /// not as RowRange says).
    void render_rows(const RenderOptions& options, const RowRange& rows, const TakeRows& take,
                     const Overrides& overrides = {}, const Watch& watch = {}) const;

    /// What the ray through the centre of each pixel hits, row by row from the top: objects are
    /// counted instances first, then spheres, then planes; no_index where it hits nothing. Throws
    /// Error (usage where the options make no picture).
    std::vector<Index> objects_seen(const RenderOptions& options,
                                    const Overrides& overrides = {}) const;

    /// Whether that ray hits an object that is no backdrop: what CompareOptions::covered counts.
    /// Throws Error (usage where the options make no picture).
    std::vector<bool> subject_seen(const RenderOptions& options) const;

    const NormalisedScene& scene() const;

  private:
    struct Prepared;
    std::unique_ptr<Prepared> prepared_;
};

// Of a scene that is rendered once. These too throw what the constructor of Tracer throws.

/// Tracer::render().
Image render(const NormalisedScene& scene, const RenderOptions& options, const Watch& watch = {});

/// Tracer::render_rows().
void render_rows(const NormalisedScene& scene, const RenderOptions& options, const RowRange& rows,
                 const TakeRows& take, const Watch& watch = {});

/// Tracer::objects_seen().
std::vector<Index> objects_seen(const NormalisedScene& scene, const RenderOptions& options);

/// The exposure, in EV and added to what is folded into the scene, at which the picture looks
/// right: its logarithmic mean becomes a middle grey, less so where that would clip the highlights.
/// Takes a small picture of single sources; a multiple of 1/4 from -32 to 32, 0 when the picture is
/// black. Throws what Tracer::render() throws.
double metered_exposure(const Tracer& tracer, const RenderOptions& options,
                        const Watch& watch = {});
/// The same of a scene of which nothing else is wanted. Throws also what the constructor of Tracer
/// throws.
double metered_exposure(const NormalisedScene& scene, const RenderOptions& options,
                        const Watch& watch = {});

}  // namespace penumbra
