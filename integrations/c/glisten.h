// glisten: lints, compiles and reflects OpenGL 3.2 era GLSL, and draws scenes on the CPU.
//
// Ownership: a handle that a function gives is the caller's, who passes it to the `_free` function of its type once. Texts
// and bytes that a function returns belong to the handle they came from, and live as long as it. Texts that are passed in are
// copied. NULL is allowed where a parameter says so, and for every `_free`.
//
// Texts are UTF-8 and end with NUL. Anything else is GLISTEN_STATUS_ARGUMENT.
//
// Threads: a compiler is changed by one thread at a time. Handles that are not being changed or freed may be used by many
// threads at once. `glisten_last_error` is of the calling thread.
//
// Functions that return a status set their output to NULL unless they succeed. A fault of glisten is
// GLISTEN_STATUS_INTERNAL; it never unwinds into the caller.
//
// Generated from integrations/c/src. Do not edit.

#ifndef GLISTEN_H
#define GLISTEN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// The size of a text that ends with NUL.
#define GLISTEN_NUL_TERMINATED ((size_t)-1)

// The version of this interface. It changes when a program that was built with an older header has to be built again.
#define GLISTEN_ABI_VERSION 1

// How a call ended.
typedef enum {
    // It has done what it was asked for.
    GLISTEN_STATUS_OK = 0,
    // A shader or a scene has errors: see its diagnostics, or `glisten_last_error` where there are none.
    GLISTEN_STATUS_CONTENT = 1,
    // An argument is wrong: NULL, a text that is not UTF-8, an unknown name or number.
    GLISTEN_STATUS_ARGUMENT = 2,
    // A file cannot be read.
    GLISTEN_STATUS_FILE = 3,
    // A fault of glisten.
    GLISTEN_STATUS_INTERNAL = 4,
} glisten_status;

// How bad something is.
typedef enum {
    // Good to know.
    GLISTEN_SEVERITY_NOTE = 0,
    // It is legal, but will hurt.
    GLISTEN_SEVERITY_WARNING = 1,
    // It is wrong, and there is no code.
    GLISTEN_SEVERITY_ERROR = 2,
} glisten_severity;

// Bytes. After the last one there is a NUL, so that those of a text are a C string.
typedef struct glisten_blob glisten_blob;

// The options of compilations. One compiler serves any number of them.
typedef struct glisten_compiler glisten_compiler;

// A picture: RGBA of every pixel of every color attachment, top row first, from left to right.
typedef struct glisten_picture glisten_picture;

// A program and everything that is wrong with it. It never changes.
typedef struct glisten_program glisten_program;

// The answer to a question for a file. It lives while the function runs that is asked. A function that answers nothing passes:
// then an include is looked for in the folders and in the library, and a file of a scene is missing.
typedef struct glisten_reply glisten_reply;

// A scene and everything that is wrong with it. It never changes.
typedef struct glisten_scene glisten_scene;

// The sources of a program in another version. It never changes.
typedef struct glisten_upgrade glisten_upgrade;

// A host's function for included files. `path` is that of the `#include`, `angled` whether it is in angle brackets, `from` the
// name of the file with the `#include`. It answers by `glisten_reply_found` or `glisten_reply_missing`, or not at all. It must not
// throw, nor jump out. It is called from each thread that compiles.
typedef void (*glisten_include_fn)(void *user,
                                   const char *path,
                                   bool angled,
                                   const char *from,
                                   glisten_reply *reply);

// A stage: one of `GLISTEN_STAGE_`.
typedef uint32_t glisten_stage;

// A source text.
typedef struct {
    // The name for diagnostics, and for finding includes: a path.
    const char *name;
    // The text.
    const char *text;
    // How many bytes the text has; `GLISTEN_NUL_TERMINATED` if it ends with NUL.
    size_t size;
    // The stage.
    glisten_stage stage;
} glisten_source;

// A target language: one of `GLISTEN_TARGET_`.
typedef uint32_t glisten_target;

// A diagnostic. Its texts belong to the program or the scene.
typedef struct {
    // How bad it is.
    glisten_severity severity;
    // The code, such as `E0201`.
    const char *code;
    // The name of the code, such as `undeclared-identifier`.
    const char *name;
    // The message.
    const char *message;
    // The help text, or NULL.
    const char *help;
    // The name of the file.
    const char *file;
    // The first line, from 1.
    uint32_t line;
    // The first column, from 1, in Unicode scalar values.
    uint32_t column;
    // The last line.
    uint32_t end_line;
    // The column after the last.
    uint32_t end_column;
} glisten_diagnostic;

// A format of diagnostics: one of `GLISTEN_FORMAT_`.
typedef uint32_t glisten_format;

// A host's function for the files of a scene: the scene itself, its shaders, meshes and images. It answers by
// `glisten_reply_found` or `glisten_reply_missing`. It must not throw, nor jump out.
typedef void (*glisten_read_fn)(void *user, const char *path, glisten_reply *reply);

// A precision of the CPU reference: one of `GLISTEN_PRECISION_`.
typedef uint32_t glisten_precision;

// The stage that the extension of the source's name tells: `.vert`, `.vs`, `.vsh`, `.geom`, `.frag`, `.fs`, ...
#define GLISTEN_STAGE_OF_NAME 0

// The vertex stage.
#define GLISTEN_STAGE_VERTEX 1

// The geometry stage: only GLSL has code for it.
#define GLISTEN_STAGE_GEOMETRY 2

// The fragment stage.
#define GLISTEN_STAGE_FRAGMENT 3

// The language of WebGPU.
#define GLISTEN_TARGET_WGSL 0

// The binary of Vulkan and OpenGL 4.6: 32-bit words, least significant byte first.
#define GLISTEN_TARGET_SPIRV 1

// The language of Metal.
#define GLISTEN_TARGET_MSL 2

// The language of Direct3D.
#define GLISTEN_TARGET_HLSL 3

// The language of OpenGL and WebGL 2, in the version of the option `glsl-version`.
#define GLISTEN_TARGET_GLSL 4

// Excerpts with carets.
#define GLISTEN_FORMAT_HUMAN 0

// A JSON array.
#define GLISTEN_FORMAT_JSON 1

// SARIF 2.1.0.
#define GLISTEN_FORMAT_SARIF 2

// Workflow commands of GitHub Actions.
#define GLISTEN_FORMAT_GITHUB 3

// Double precision.
#define GLISTEN_PRECISION_F64 0

// Single precision, with one rounding per operation.
#define GLISTEN_PRECISION_F32 1

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Why the last call of this thread that failed did so, as a sentence; NULL if none failed. It lives until the next call of
// this thread that fails.
const char *glisten_last_error(void);

// The version of glisten, such as "0.1.0". It lives forever.
const char *glisten_version(void);

// The `GLISTEN_ABI_VERSION` of the library, to compare with that of the header.
uint32_t glisten_abi_version(void);

// The bytes; NULL for NULL.
const char *glisten_blob_data(const glisten_blob *blob);

// How many bytes there are, without the NUL after them; 0 for NULL.
size_t glisten_blob_size(const glisten_blob *blob);

// Frees the bytes.
void glisten_blob_free(glisten_blob *blob);

// Answers with the bytes of the file, which are copied. `name` is for diagnostics and for the includes of that file; NULL stands
// for the path that was asked for.
glisten_status glisten_reply_found(glisten_reply *reply,
                                   const char *name,
                                   const char *bytes,
                                   size_t size);

// Answers that there is no such file, for a reason: a sentence without a full stop.
glisten_status glisten_reply_missing(glisten_reply *reply, const char *reason);

// A compiler without options. Never NULL.
glisten_compiler *glisten_compiler_new(void);

// Frees a compiler. Programs and scenes made with it live on.
void glisten_compiler_free(glisten_compiler *compiler);

// Sets an option as the flag of the same name of `glisten compile` does: `clip-z` to `minus-one-to-one`, `deny` to `warnings`. See
// integrations/c/README.md for all of them.
glisten_status glisten_compiler_set(glisten_compiler *compiler,
                                    const char *option,
                                    const char *value);

// Defines a macro before the first line of each source. A `value` of NULL is 1.
glisten_status glisten_compiler_define(glisten_compiler *compiler, const char *name, const char *value);

// Adds a folder to the search path of `#include`.
glisten_status glisten_compiler_add_include_folder(glisten_compiler *compiler, const char *folder);

// Binds a vertex attribute to a location, as `glBindAttribLocation` does.
glisten_status glisten_compiler_bind_attribute(glisten_compiler *compiler,
                                               const char *name,
                                               uint32_t location);

// Binds a fragment output to a color number, as `glBindFragDataLocation` does.
glisten_status glisten_compiler_bind_output(glisten_compiler *compiler,
                                            const char *name,
                                            uint32_t color_number);

// Sets the function that is asked first for included files, and the pointer that it gets. With NULL, nobody is asked. If `in_memory`,
// the disk is not searched for what it does not answer.
glisten_status glisten_compiler_set_include(glisten_compiler *compiler,
                                            glisten_include_fn function,
                                            void *user,
                                            bool in_memory);

// Compiles the sources of one program. There is a program, with its diagnostics, if the status is `GLISTEN_STATUS_OK` or
// `GLISTEN_STATUS_CONTENT`; the latter if there are errors.
glisten_status glisten_compile(const glisten_compiler *compiler,
                               const glisten_source *sources,
                               size_t count,
                               glisten_program **program);

// Compiles as `glisten_compile` does, and also looks for what is legal but will hurt. A part of a program is no error here.
glisten_status glisten_lint(const glisten_compiler *compiler,
                            const glisten_source *sources,
                            size_t count,
                            glisten_program **program);

// Frees a program.
void glisten_program_free(glisten_program *program);

// Whether the program has a stage, and no errors.
bool glisten_program_has_stage(const glisten_program *program, glisten_stage stage);

// Emits the code of a stage for a target. What the target cannot represent is `GLISTEN_STATUS_CONTENT`, with the diagnostics in
// `glisten_last_error`.
glisten_status glisten_program_emit(const glisten_program *program,
                                    glisten_stage stage,
                                    glisten_target target,
                                    glisten_blob **code);

// Gives what a host needs to know about the program as JSON: attributes, uniforms with their offsets, bindings, varyings,
// outputs. Its form is `docs/reflection.schema.json`.
glisten_status glisten_program_reflect(const glisten_program *program,
                                       glisten_blob **json);

// How many diagnostics the program has; 0 for NULL.
size_t glisten_program_diagnostic_count(const glisten_program *program);

// Writes a diagnostic of the program to `diagnostic`. They are in the order of their places.
glisten_status glisten_program_diagnostic(const glisten_program *program,
                                          size_t index,
                                          glisten_diagnostic *diagnostic);

// Gives all diagnostics of the program as a text.
glisten_status glisten_program_diagnostics(const glisten_program *program,
                                           glisten_format format,
                                           glisten_blob **text);

// Rewrites the sources of a program, as `glisten upgrade` does, for the version `150`, `330`, `450`, `460`, `300es` or `vulkan`. Files that they include
// stay as they are. With errors in the sources, which `glisten_last_error` shows, the status is `GLISTEN_STATUS_CONTENT`; so it is
// if a source is newer than the version, or has a name that the version has no counterpart for.
glisten_status glisten_upgrade_sources(const glisten_compiler *compiler,
                                       const glisten_source *sources,
                                       size_t count,
                                       const char *version,
                                       glisten_upgrade **upgraded);

// Frees an upgrade.
void glisten_upgrade_free(glisten_upgrade *upgrade);

// The new text of the source with this number, from 0; NULL if there is none.
const char *glisten_upgrade_text(const glisten_upgrade *upgrade, size_t index);

// A sentence for the author of the host, from 0; NULL if there is none with this number.
const char *glisten_upgrade_note(const glisten_upgrade *upgrade, size_t index);

// Loads the scene at a path: from the disk, or with the files of `function`, unless it is NULL. Statuses are those of
// `glisten_compile`, and `GLISTEN_STATUS_FILE` if a file is missing.
glisten_status glisten_scene_load(const glisten_compiler *compiler,
                                  const char *path,
                                  glisten_read_fn function,
                                  void *user,
                                  glisten_scene **scene);

// Frees a scene.
void glisten_scene_free(glisten_scene *scene);

// How many diagnostics the scene has; 0 for NULL.
size_t glisten_scene_diagnostic_count(const glisten_scene *scene);

// Writes a diagnostic of the scene to `diagnostic`.
glisten_status glisten_scene_diagnostic(const glisten_scene *scene,
                                        size_t index,
                                        glisten_diagnostic *diagnostic);

// Gives all diagnostics of the scene as a text.
glisten_status glisten_scene_diagnostics(const glisten_scene *scene,
                                         glisten_format format,
                                         glisten_blob **text);

// Draws the scene on the CPU, which may use many threads. It fails with `GLISTEN_STATUS_CONTENT` if the scene has errors.
glisten_status glisten_render(const glisten_scene *scene,
                              glisten_precision precision,
                              glisten_picture **picture);

// Frees a picture.
void glisten_picture_free(glisten_picture *picture);

// The width in pixels; 0 for NULL.
uint32_t glisten_picture_width(const glisten_picture *picture);

// The height in pixels; 0 for NULL.
uint32_t glisten_picture_height(const glisten_picture *picture);

// How many color attachments there are; 0 for NULL.
uint32_t glisten_picture_attachments(const glisten_picture *picture);

// Writes an attachment as float: `count` is 4 times the width times the height.
glisten_status glisten_picture_read_f32(const glisten_picture *picture,
                                        uint32_t attachment,
                                        float *channels,
                                        size_t count);

// Writes an attachment as double: `count` is 4 times the width times the height.
glisten_status glisten_picture_read_f64(const glisten_picture *picture,
                                        uint32_t attachment,
                                        double *channels,
                                        size_t count);

// Writes an attachment as bytes, clamped to [0, 1] and scaled to 255, without gamma: `count` is 4 times the width times the
// height.
glisten_status glisten_picture_read_u8(const glisten_picture *picture,
                                       uint32_t attachment,
                                       uint8_t *channels,
                                       size_t count);

// Writes for each pixel whether a fragment was drawn there (1 or 0): `count` is the width times the height.
glisten_status glisten_picture_read_covered(const glisten_picture *picture, uint8_t *covered, size_t count);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* GLISTEN_H */
