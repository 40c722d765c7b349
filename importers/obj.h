// OBJ and MTL files -> Scene, in steps: bytes -> clean text -> Model -> meshes and materials.
//
// tinyobjloader parses, but it reads what is wrong as zeros, knows neither line continuation nor
// comments behind a statement, and opens any path. So its input is cleaned and checked before
// (obj_text.cpp, mtl_text.cpp) and all indices after (obj_parse.cpp), and files are read here.
#pragma once

#include "image_store.h"
#include "model_folders.h"

#include "penumbra/importers.h"

#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace penumbra::obj {

/// Counts what is left out, one Loss a kind at the place of its first occurrence.
class Tally {
  public:
    explicit Tally(std::string of_file) : file(std::move(of_file)) {}
    /// `line` 0: the file as a whole. Beyond a thousand kinds all are one.
    void add(const std::string& what, Index line);
    /// In order of first occurrence; "(n times)" is added to what occurred more than once.
    void append_to(Losses& losses) const;
    /// Adds what a later part of the file has left out.
    void append(const Tally& later);

  private:
    struct Entry {
        std::string what = {};
        Index line = 0;
        std::size_t count = 0;
    };
    std::string file = {};
    std::vector<Entry> entries = {};
    std::unordered_map<std::string, std::size_t> by_what = {};
};

/// "chair.obj:7"
std::string place_of(const std::string& file, Index line);

// ---- obj_encoding.cpp -------------------------------------------------------------------------

/// `bytes` as UTF-8 with '\n' at line ends: byte order marks are dropped, UTF-16 is converted, and
/// what is not valid UTF-8 is taken as Latin-1.
std::string to_utf8(std::string bytes);

/// Joins lines that end in a backslash; blank lines follow, so that line numbers stay. Comment
/// lines, which may end in a Windows path, are left alone.
std::string join_lines(std::string text);

/// `text` on one line: control characters become '?', what is beyond 60 bytes is cut.
std::string printable(std::string_view text);

// ---- obj_words.cpp ----------------------------------------------------------------------------

std::string_view trim(std::string_view text);

/// Takes the next word off the front of `text`; empty at the end.
std::string_view next_word(std::string_view& text);

/// The text before a '#', but for that of "1.#IND", which some programs write for NaN.
std::string_view without_comment(std::string_view text);

/// The same for names, which may hold a '#' ("Material #25"): a comment begins with " # ".
std::string_view name_without_comment(std::string_view text);

enum class Word { number, not_finite, other };

/// What `word` is, by the grammar that tinyobjloader reads rightly.
Word kind_of(std::string_view word);

std::string lower_case(std::string_view text);

// ---- obj_paths.cpp ----------------------------------------------------------------------------

/// A file that a model names.
struct Found {
    std::filesystem::path file = {};  ///< empty: none; else the model's folder and the way from it
    std::string refusal = {};         ///< why the name was not followed as it stands; may be empty
};

/// Looks for `name`, as an OBJ or MTL file writes it, in the model's folder or below. `from` is
/// where the naming file lies, relative to that folder. Backslashes separate too, case is ignored
/// where there is no exact match. A path that leads to no allowed folder is refused; a file of the
/// same name in the model's folder is taken for it.
Found find_below(const ModelFolders& folders, const std::filesystem::path& from,
                 std::string_view name);

// ---- obj_text.cpp -----------------------------------------------------------------------------

struct Named {
    std::string name = {};
    Index line = 0;
};

/// How many statements, or corners of faces, there are.
struct Counts {
    std::size_t positions = 0, texcoords = 0, normals = 0, faces = 0, corners = 0;
};

/// From a face on: the object, group, material (names) or smoothing group (a number).
struct Change {
    enum class Of { object, group, material, smoothing };
    Of of = Of::object;
    std::size_t face = 0;  ///< in the piece
    std::string name = {};
    Index number = 0;
    Index line = 0;
};

/// A run of whole lines of an OBJ file that tinyobjloader reads rightly, and what it would not hand
/// on.
struct Piece {
    Index first_line = 1;
    std::string text = {};  ///< statements v vt vn f only, on their original lines
    Counts counts = {};     ///< of them
    std::vector<Index> face_lines = {};
    std::vector<Change> changes = {};
    std::vector<Color> colors = {};     ///< as in the file, of those v that have one
    Index first_bare = 0;               ///< line of the first v without a colour; 0: none
    float brightest = 0;                ///< of the colours' components
    std::vector<Named> libraries = {};  ///< operands of mtllib
};

/// Checks and cleans an OBJ file, all pieces at once. Throws Error (input) with the line.
std::vector<Piece> clean_obj(std::string bytes, const std::string& file, Tally& tally);

// ---- obj_parse.cpp ----------------------------------------------------------------------------

struct Corner {
    Index position = 0;  ///< into Model::positions
    Index texcoord = no_index, normal = no_index;
    bool operator==(const Corner&) const = default;
};

struct Face {
    std::size_t first = 0;  ///< into Model::corners; ends where the next Face begins
    Index count = 0;
    Index line = 0;
    Index part = 0;       ///< into Model::parts
    Index smoothing = 0;  ///< group; 0: flat
};

/// Faces of one object and group with one material.
struct Part {
    std::string name = {};
    Index material = no_index;  ///< into Model::materials
};

/// What an OBJ file says, with every index in range and every position finite.
struct Model {
    std::string file = {};  ///< as the user wrote it
    std::vector<Vec3> positions = {};
    std::vector<Vec2> texcoords = {};
    std::vector<Vec3> normals = {};  ///< unit; zero where the file's cannot be used
    std::vector<Color> colors = {};  ///< linear; empty, or one per position
    std::vector<Corner> corners = {};
    std::vector<Face> faces = {};
    std::vector<Part> parts = {};
    std::vector<Named> materials = {};  ///< names in order of first use

    std::span<const Corner> corners_of(const Face& face) const {
        return std::span(corners).subspan(face.first, face.count);
    }
};

/// Parses a cleaned OBJ file, all pieces at once. Throws Error (input) with the line.
Model parse(const std::vector<Piece>& pieces, const std::string& file, Tally& tally);

// ---- obj_normals.cpp --------------------------------------------------------------------------

/// Gives corners without a normal that of their smoothing group, and takes unusable ones away;
/// what is left without one (no_index) is flat.
void resolve_normals(Model& model, Tally& tally);

// ---- obj_mesh.cpp -----------------------------------------------------------------------------

/// Appends one mesh and instance per part. The scene's materials go with Model::materials.
void build_meshes(Model model, Scene& scene, Tally& tally);

// ---- mtl_text.cpp -----------------------------------------------------------------------------

struct Statement {
    std::string key = {};   ///< lower case
    std::string word = {};  ///< as the file has it
    std::string operands = {};
    Index line = 0;
};

/// One newmtl with its statements.
struct MtlEntry {
    std::string name = {};
    std::string file = {};            ///< for messages
    std::filesystem::path from = {};  ///< its folder, relative to the model's
    Index line = 0;
    std::vector<Statement> statements = {};
};

/// Counts what materials lose: the same sentence about several of them becomes one Loss, at the
/// first.
class MaterialTally {
  public:
    void add(const MtlEntry& entry, Index line, const std::string& what);
    void append_to(Losses& losses) const;

  private:
    struct Told {
        std::string place = {}, material = {}, what = {};
        std::size_t others = 0;
        const MtlEntry* last = nullptr;
    };
    std::vector<Told> all = {};
    std::unordered_map<std::string, std::size_t> by_what = {};
};

/// Reads the materials of all libraries that a model names. What is missing is lost, not wrong.
std::vector<MtlEntry> read_libraries(const std::vector<Named>& libraries, const std::string& model,
                                     const ModelFolders& folders, Losses& losses);

// ---- mtl_values.cpp ---------------------------------------------------------------------------

/// The numbers of a material; what the file does not give is absent.
struct MtlValues {
    std::optional<Color> ambient = {}, diffuse = {}, specular = {}, emission = {}, filter = {};
    std::optional<float> shininess = {}, ior = {}, dissolve = {};
    std::optional<float> roughness = {}, metallic = {}, coat = {}, coat_roughness = {};
    std::optional<int> illum = {};
    std::vector<Statement> maps = {};  ///< statements that name a texture
};

MtlValues read_values(const MtlEntry& entry, MaterialTally& tally);

// ---- mtl_map.cpp ------------------------------------------------------------------------------

/// The operands of a texture statement: options before or after a file name with blanks.
struct MapOperands {
    std::string file = {};
    bool clamp = false;
    std::array<double, 6> transform = ImageMap().transform;  ///< -s and -o
    double base = 0, gain = 1;                               ///< -mm: base + gain x the sample
    double bump = 1;                                         ///< -bm
    char channel = '\0';                    ///< -imfchan: r g b, m for alpha, l; 0: not given
    std::vector<std::string> ignored = {};  ///< options that the Scene cannot hold

    bool is_ranged() const { return base != 0 || gain != 1; }
};
MapOperands parse_map(std::string_view operands);

/// A texture statement whose image can be read.
struct MapImage {
    std::string word = {};  ///< the statement's, for messages
    Index line = 0;
    std::filesystem::path file = {};
    MapOperands operands = {};

    ImageMap laid() const { return {.transform = operands.transform}; }
};

/// Decodes texture files, each once as far as memory allows.
class TextureReader {
  public:
    TextureReader(ModelFolders of_model, Scene& into, MaterialTally& lost);

    /// The image that `statement` names, if there is one, will be opened later: it may be decoded
    /// ahead.
    void expect(const MtlEntry& entry, const Statement& statement);

    /// The image that `statement` names; none, and a loss, if it cannot be had.
    std::optional<MapImage> open(const MtlEntry& entry, const Statement& statement);

    /// Its samples, which stay as ImageStore says. Throws Error (input) where the file has changed
    /// meanwhile.
    const Raster& raster(const MapImage& image);

    /// The Scene's texture with its samples.
    Index texture(const MapImage& image, bool srgb);

    /// The Scene's texture that `make` derives from it; `use`, whose first word ends its name, and
    /// `srgb` tell it from others.
    Index derived(const MapImage& image, const std::string& use, bool srgb,
                  const std::function<Raster()>& make);

  private:
    Found locate(const MtlEntry& entry, const std::string& name) const;

    Raster decode(const std::filesystem::path& file) const;

    ModelFolders folders = {};
    Scene& scene;
    MaterialTally& tally;
    ImageStore store = {};                           ///< by file
    std::map<std::string, std::string> broken = {};  ///< by file: what is wrong with it
    std::map<std::string, Index> known = {};         ///< by file, options and use
};

// ---- mtl.cpp ----------------------------------------------------------------------------------

/// Appends the materials that the model uses.
void build_materials(const Model& model, const std::vector<MtlEntry>& entries,
                     const ModelFolders& folders, Imported& result);

}  // namespace penumbra::obj
