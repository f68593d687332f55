// glisten for C++17: handles that free themselves, and exceptions instead of statuses. It needs glisten.h and nothing else.

#ifndef GLISTEN_HPP
#define GLISTEN_HPP

#include "glisten.h"

#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glisten {

// Frees a handle by the function of its type.
struct Free {
    void operator()(glisten_blob *handle) const noexcept { glisten_blob_free(handle); }
    void operator()(glisten_compiler *handle) const noexcept { glisten_compiler_free(handle); }
    void operator()(glisten_picture *handle) const noexcept { glisten_picture_free(handle); }
    void operator()(glisten_program *handle) const noexcept { glisten_program_free(handle); }
    void operator()(glisten_scene *handle) const noexcept { glisten_scene_free(handle); }
    void operator()(glisten_upgrade *handle) const noexcept { glisten_upgrade_free(handle); }
};

template <class Handle>
using Owned = std::unique_ptr<Handle, Free>;

// A call that failed.
class Error : public std::runtime_error {
public:
    Error(glisten_status status, const char *message)
        : std::runtime_error(message ? message : "glisten failed"), status_(status) {}

    glisten_status status() const noexcept { return status_; }

private:
    glisten_status status_;
};

// Throws unless the call succeeded.
inline void check(glisten_status status) {
    if (status != GLISTEN_STATUS_OK) throw Error(status, glisten_last_error());
}

// The bytes of a blob.
inline std::string bytes_of(Owned<glisten_blob> blob) {
    return std::string(glisten_blob_data(blob.get()), glisten_blob_size(blob.get()));
}

// A source text.
struct Source {
    std::string name;
    std::string text;
    glisten_stage stage = GLISTEN_STAGE_OF_NAME;
};

// A program and everything that is wrong with it.
class Program {
public:
    explicit Program(glisten_program *handle) : handle_(handle) {}

    // Whether the program has a stage, and no errors.
    bool has_stage(glisten_stage stage) const noexcept { return glisten_program_has_stage(handle_.get(), stage); }

    // The diagnostics. Their texts live as long as the program.
    std::vector<glisten_diagnostic> diagnostics() const {
        std::vector<glisten_diagnostic> all(glisten_program_diagnostic_count(handle_.get()));
        for (std::size_t index = 0; index < all.size(); ++index)
            check(glisten_program_diagnostic(handle_.get(), index, &all[index]));
        return all;
    }

    // The diagnostics as a text.
    std::string diagnostics(glisten_format format) const {
        glisten_blob *text = nullptr;
        check(glisten_program_diagnostics(handle_.get(), format, &text));
        return bytes_of(Owned<glisten_blob>(text));
    }

    // The code of a stage as bytes.
    std::string emit(glisten_stage stage, glisten_target target) const {
        glisten_blob *code = nullptr;
        check(glisten_program_emit(handle_.get(), stage, target, &code));
        return bytes_of(Owned<glisten_blob>(code));
    }

    // The code of a stage as words of SPIR-V.
    std::vector<std::uint32_t> spirv(glisten_stage stage) const {
        const std::string code = emit(stage, GLISTEN_TARGET_SPIRV);
        std::vector<std::uint32_t> words(code.size() / 4);
        std::memcpy(words.data(), code.data(), 4 * words.size());
        return words;
    }

    // The reflection as JSON.
    std::string reflection() const {
        glisten_blob *json = nullptr;
        check(glisten_program_reflect(handle_.get(), &json));
        return bytes_of(Owned<glisten_blob>(json));
    }

    const glisten_program *handle() const noexcept { return handle_.get(); }

private:
    Owned<glisten_program> handle_;
};

// The sources of a program in another version.
struct Upgraded {
    std::vector<std::string> texts;
    // Sentences for the author of the host.
    std::vector<std::string> notes;
};

// A picture: RGBA of every pixel, top row first.
class Picture {
public:
    explicit Picture(glisten_picture *handle) : handle_(handle) {}

    std::uint32_t width() const noexcept { return glisten_picture_width(handle_.get()); }
    std::uint32_t height() const noexcept { return glisten_picture_height(handle_.get()); }
    std::uint32_t attachments() const noexcept { return glisten_picture_attachments(handle_.get()); }

    std::vector<float> floats(std::uint32_t attachment = 0) const {
        std::vector<float> channels(std::size_t{4} * width() * height());
        check(glisten_picture_read_f32(handle_.get(), attachment, channels.data(), channels.size()));
        return channels;
    }

    std::vector<std::uint8_t> bytes(std::uint32_t attachment = 0) const {
        std::vector<std::uint8_t> channels(std::size_t{4} * width() * height());
        check(glisten_picture_read_u8(handle_.get(), attachment, channels.data(), channels.size()));
        return channels;
    }

private:
    Owned<glisten_picture> handle_;
};

// A scene and everything that is wrong with it.
class Scene {
public:
    explicit Scene(glisten_scene *handle) : handle_(handle) {}

    // The diagnostics as a text.
    std::string diagnostics(glisten_format format) const {
        glisten_blob *text = nullptr;
        check(glisten_scene_diagnostics(handle_.get(), format, &text));
        return bytes_of(Owned<glisten_blob>(text));
    }

    // Draws the scene on the CPU.
    Picture render(glisten_precision precision = GLISTEN_PRECISION_F64) const {
        glisten_picture *picture = nullptr;
        check(glisten_render(handle_.get(), precision, &picture));
        return Picture(picture);
    }

private:
    Owned<glisten_scene> handle_;
};

// The options of compilations.
class Compiler {
public:
    // Finds included files: the text of a path, or nothing. It is called from each thread that compiles.
    using Include = std::function<std::optional<std::string>(std::string_view path, bool angled, std::string_view from)>;

    Compiler() : handle_(glisten_compiler_new()) {}

    Compiler &set(const std::string &option, const std::string &value) {
        check(glisten_compiler_set(handle_.get(), option.c_str(), value.c_str()));
        return *this;
    }

    Compiler &define(const std::string &name, const std::string &value = "1") {
        check(glisten_compiler_define(handle_.get(), name.c_str(), value.c_str()));
        return *this;
    }

    Compiler &include_folder(const std::string &folder) {
        check(glisten_compiler_add_include_folder(handle_.get(), folder.c_str()));
        return *this;
    }

    Compiler &bind_attribute(const std::string &name, std::uint32_t location) {
        check(glisten_compiler_bind_attribute(handle_.get(), name.c_str(), location));
        return *this;
    }

    Compiler &bind_output(const std::string &name, std::uint32_t color_number) {
        check(glisten_compiler_bind_output(handle_.get(), name.c_str(), color_number));
        return *this;
    }

    // The function that is asked first for included files. If `in_memory`, the disk is not searched.
    Compiler &include(Include function, bool in_memory = false) {
        auto kept = std::make_unique<Include>(std::move(function));
        check(glisten_compiler_set_include(handle_.get(), &Compiler::ask, kept.get(), in_memory));
        include_ = std::move(kept);
        return *this;
    }

    Program compile(const std::vector<Source> &sources) const { return made(sources, glisten_compile); }

    Program lint(const std::vector<Source> &sources) const { return made(sources, glisten_lint); }

    // Rewrites sources for the version `150`, `330`, `450`, `460`, `300es` or `vulkan`.
    Upgraded upgrade(const std::vector<Source> &sources, const std::string &version = "150") const {
        const std::vector<glisten_source> rows = rows_of(sources);
        glisten_upgrade *handle = nullptr;
        check(glisten_upgrade_sources(handle_.get(), rows.data(), rows.size(), version.c_str(), &handle));
        const Owned<glisten_upgrade> owned(handle);
        Upgraded upgraded;
        for (std::size_t index = 0; const char *text = glisten_upgrade_text(handle, index); ++index)
            upgraded.texts.emplace_back(text);
        for (std::size_t index = 0; const char *note = glisten_upgrade_note(handle, index); ++index)
            upgraded.notes.emplace_back(note);
        return upgraded;
    }

    // Loads a scene from the disk. A scene with errors can be asked for its diagnostics.
    Scene load(const std::string &path) const {
        glisten_scene *scene = nullptr;
        const glisten_status status = glisten_scene_load(handle_.get(), path.c_str(), nullptr, nullptr, &scene);
        if (status != GLISTEN_STATUS_CONTENT) check(status);
        return Scene(scene);
    }

private:
    // They live as long as the sources.
    static std::vector<glisten_source> rows_of(const std::vector<Source> &sources) {
        std::vector<glisten_source> rows;
        for (const Source &source : sources)
            rows.push_back({source.name.c_str(), source.text.c_str(), source.text.size(), source.stage});
        return rows;
    }

    template <class Function>
    Program made(const std::vector<Source> &sources, Function function) const {
        const std::vector<glisten_source> rows = rows_of(sources);
        glisten_program *program = nullptr;
        const glisten_status status = function(handle_.get(), rows.data(), rows.size(), &program);
        if (status != GLISTEN_STATUS_CONTENT) check(status);
        return Program(program);
    }

    // No exception may pass through glisten.
    static void ask(void *user, const char *path, bool angled, const char *from, glisten_reply *reply) noexcept {
        try {
            if (const auto text = (*static_cast<Include *>(user))(path, angled, from))
                glisten_reply_found(reply, nullptr, text->data(), text->size());
        } catch (const std::exception &error) {
            glisten_reply_missing(reply, error.what());
        } catch (...) {
            glisten_reply_missing(reply, "the include function threw");
        }
    }

    Owned<glisten_compiler> handle_;
    std::unique_ptr<Include> include_;
};

}  // namespace glisten

#endif
