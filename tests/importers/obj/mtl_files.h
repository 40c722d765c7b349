// Small models with material libraries and textures.
#pragma once

#include "importers/obj/obj_files.h"

namespace test {

/// One facet with texture coordinates, without a face statement.
inline const std::string facet = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";

/// A model in a folder of its own whose only facet has material "a".
struct Files {
    TempDir folder = {};

    fs::path path(const std::string& name) const { return folder.path / name; }

    void image(const std::string& name) const {
        fs::create_directories(path(name).parent_path());
        penumbra::Raster raster = {.width = 2, .height = 1, .channels = 3};
        raster.data.assign(6, std::byte(200));
        save_raster(path(name), raster);
    }

    Imported read(const std::string& mtl, const std::string& library = "a.mtl",
                  const std::string& usemtl = "a") const {
        write(path("a.mtl"), mtl);
        return penumbra::read_obj(
            write(path("m.obj"),
                  "mtllib " + library + "\n" + facet + "usemtl " + usemtl + "\nf 1/1 2/2 3/3\n"));
    }

    penumbra::Material material(const std::string& mtl) const {
        const Imported imported = read(mtl);
        REQUIRE(imported.scene.materials.size() == 1);
        CHECK(lost(imported) == Lines{});
        return imported.scene.materials[0];
    }

    Lines losses(const std::string& mtl) const { return lost(read(mtl)); }

    // "a.mtl:7: what", with paths shortened.
    Lines lost(const Imported& imported) const {
        Lines result;
        for (const Loss& loss : imported.losses) {
            std::string line = loss.place + ": " + loss.what;
            const std::string prefix = folder.path.string() + '/';
            for (std::size_t at = line.find(prefix); at != std::string::npos;
                 at = line.find(prefix))
                line.erase(at, prefix.size());
            result.push_back(line);
        }
        return result;
    }
};

}  // namespace test
