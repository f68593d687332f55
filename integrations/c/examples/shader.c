/* Compiles a program to WGSL and SPIR-V, reads its reflection, shows an error, and draws a scene: with files from memory alone.
 *
 *   cc -I. examples/shader.c -L../../target/debug -lglisten -o shader
 */

#include <glisten.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(call)                                                                     \
    do {                                                                                \
        const glisten_status status_ = (call);                                          \
        if (status_ != GLISTEN_STATUS_OK) {                                             \
            fprintf(stderr, "%s: status %d: %s\n", #call, (int)status_, glisten_last_error()); \
            exit(1);                                                                    \
        }                                                                               \
    } while (0)

#define EXPECT(what)                                                     \
    do {                                                                 \
        if (!(what)) {                                                   \
            fprintf(stderr, "line %d: %s does not hold\n", __LINE__, #what); \
            exit(1);                                                     \
        }                                                                \
    } while (0)

static const char VERTEX[] =
    "#version 150\n"
    "void main() { gl_Position = vec4(vec2[](vec2(-1), vec2(3, -1), vec2(-1, 3))[gl_VertexID], 0.0, 1.0); }\n";
static const char FRAGMENT[] =
    "#version 150\n"
    "#include \"tint.glsl\"\n"
    "#include <glisten/srgb.glsl>\n"
    "uniform float level;\n"
    "out vec4 color;\n"
    "void main() { color = vec4(TINT * level, 1.0); }\n";
static const char SCENE[] =
    "[framebuffer]\nwidth = 8\nheight = 4\n"
    "[[draw]]\nvertex = \"shader.vert\"\nfragment = \"shader.frag\"\nvertex_count = 3\n"
    "[draw.uniforms]\nlevel = 0.5\n";

/* Answers for included files: `user` is a counter. */
static void include(void *user, const char *path, bool angled, const char *from, glisten_reply *reply) {
    if (angled) return; /* The library of glisten has it. */
    EXPECT(strstr(from, "shader.frag") != NULL);
    ++*(int *)user;
    if (strcmp(path, "tint.glsl") == 0) {
        const char text[] = "const vec3 TINT = vec3(0.5, 1.0, SHADE);\n";
        CHECK(glisten_reply_found(reply, "memory/tint.glsl", text, sizeof text - 1));
    } else {
        CHECK(glisten_reply_missing(reply, "this host has no such file"));
    }
}

/* Answers for the files of the scene. */
static void read(void *user, const char *path, glisten_reply *reply) {
    (void)user;
    const char *text = strcmp(path, "scene.toml") == 0    ? SCENE
                       : strcmp(path, "shader.vert") == 0 ? VERTEX
                       : strcmp(path, "shader.frag") == 0 ? FRAGMENT
                                                          : NULL;
    if (text) CHECK(glisten_reply_found(reply, NULL, text, strlen(text)));
}

static glisten_program *compiled(const glisten_compiler *compiler) {
    const glisten_source sources[] = {
        {"shader.vert", VERTEX, GLISTEN_NUL_TERMINATED, GLISTEN_STAGE_OF_NAME},
        {"shader.frag", FRAGMENT, sizeof FRAGMENT - 1, GLISTEN_STAGE_FRAGMENT},
    };
    glisten_program *program;
    CHECK(glisten_compile(compiler, sources, 2, &program));
    return program;
}

static void show_code(const glisten_program *program) {
    glisten_blob *code;
    CHECK(glisten_program_emit(program, GLISTEN_STAGE_FRAGMENT, GLISTEN_TARGET_WGSL, &code));
    EXPECT(strlen(glisten_blob_data(code)) == glisten_blob_size(code));
    EXPECT(strstr(glisten_blob_data(code), "@fragment"));
    printf("%s\n", glisten_blob_data(code));
    glisten_blob_free(code);

    CHECK(glisten_program_emit(program, GLISTEN_STAGE_VERTEX, GLISTEN_TARGET_SPIRV, &code));
    uint32_t magic;
    memcpy(&magic, glisten_blob_data(code), sizeof magic);
    EXPECT(magic == 0x07230203 && glisten_blob_size(code) % 4 == 0);
    glisten_blob_free(code);
    for (glisten_target target = GLISTEN_TARGET_MSL; target <= GLISTEN_TARGET_GLSL; ++target) {
        CHECK(glisten_program_emit(program, GLISTEN_STAGE_FRAGMENT, target, &code));
        glisten_blob_free(code);
    }
    CHECK(glisten_program_reflect(program, &code));
    EXPECT(strstr(glisten_blob_data(code), "\"level\""));
    glisten_blob_free(code);
}

static void show_errors(const glisten_compiler *compiler) {
    const glisten_source source = {"wrong.frag", "#version 150\nvoid main() { colour = 1; }\n", GLISTEN_NUL_TERMINATED, 0};
    glisten_program *program;
    EXPECT(glisten_lint(compiler, &source, 1, &program) == GLISTEN_STATUS_CONTENT);
    EXPECT(!glisten_program_has_stage(program, GLISTEN_STAGE_FRAGMENT));
    glisten_diagnostic found;
    CHECK(glisten_program_diagnostic(program, 0, &found));
    printf("%s:%u:%u: %s [%s]\n", found.file, found.line, found.column, found.message, found.code);
    EXPECT(found.severity == GLISTEN_SEVERITY_ERROR && found.line == 2);
    glisten_blob *text;
    CHECK(glisten_program_diagnostics(program, GLISTEN_FORMAT_SARIF, &text));
    EXPECT(strstr(glisten_blob_data(text), "\"2.1.0\""));
    glisten_blob_free(text);
    EXPECT(glisten_program_emit(program, GLISTEN_STAGE_FRAGMENT, GLISTEN_TARGET_WGSL, &text) == GLISTEN_STATUS_CONTENT);
    EXPECT(text == NULL);
    glisten_program_free(program);
}

static void draw(const glisten_compiler *compiler) {
    glisten_scene *scene;
    CHECK(glisten_scene_load(compiler, "scene.toml", read, NULL, &scene));
    glisten_picture *picture;
    CHECK(glisten_render(scene, GLISTEN_PRECISION_F64, &picture));
    glisten_scene_free(scene);
    EXPECT(glisten_picture_width(picture) == 8 && glisten_picture_height(picture) == 4);
    float pixels[8 * 4 * 4];
    CHECK(glisten_picture_read_f32(picture, 0, pixels, sizeof pixels / sizeof *pixels));
    printf("%g %g %g %g\n", pixels[0], pixels[1], pixels[2], pixels[3]);
    EXPECT(pixels[0] == 0.25f && pixels[1] == 0.5f && pixels[2] == 0.125f && pixels[3] == 1.0f);
    uint8_t bytes[8 * 4 * 4];
    CHECK(glisten_picture_read_u8(picture, 0, bytes, sizeof bytes));
    EXPECT(bytes[0] == 64 && bytes[1] == 128 && bytes[3] == 255);
    uint8_t covered[8 * 4];
    CHECK(glisten_picture_read_covered(picture, covered, sizeof covered));
    EXPECT(covered[0] == 1);
    EXPECT(glisten_picture_read_f32(picture, 0, pixels, 3) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(glisten_picture_read_f32(picture, 1, pixels, 128) == GLISTEN_STATUS_ARGUMENT);
    glisten_picture_free(picture);
}

/* Sources of older versions are rewritten. */
static void upgrade(const glisten_compiler *compiler) {
    const glisten_source old = {"old.frag", "varying vec4 tint;\nvoid main() { gl_FragColor = tint; }\n", GLISTEN_NUL_TERMINATED, 0};
    glisten_upgrade *upgraded;
    CHECK(glisten_upgrade_sources(compiler, &old, 1, "330", &upgraded));
    printf("%s", glisten_upgrade_text(upgraded, 0));
    EXPECT(strstr(glisten_upgrade_text(upgraded, 0), "in vec4 tint;"));
    EXPECT(glisten_upgrade_text(upgraded, 1) == NULL && glisten_upgrade_note(upgraded, 0) == NULL);
    glisten_upgrade_free(upgraded);
    EXPECT(glisten_upgrade_sources(compiler, &old, 1, "440", &upgraded) == GLISTEN_STATUS_ARGUMENT && upgraded == NULL);
    const glisten_source wrong = {"wrong.frag", "void main() { colour; }\n", GLISTEN_NUL_TERMINATED, 0};
    EXPECT(glisten_upgrade_sources(compiler, &wrong, 1, "330", &upgraded) == GLISTEN_STATUS_CONTENT);
    EXPECT(strstr(glisten_last_error(), "`colour` is not declared"));
    EXPECT(glisten_upgrade_sources(NULL, &old, 1, "330", &upgraded) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(glisten_upgrade_sources(compiler, &old, 1, NULL, &upgraded) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(glisten_upgrade_text(NULL, 0) == NULL && glisten_upgrade_note(NULL, 0) == NULL);
    glisten_upgrade_free(NULL);
}

/* Wrong arguments end in a status, never in a crash. */
static void misuse(glisten_compiler *compiler) {
    glisten_program *program = (glisten_program *)1;
    const glisten_source source = {"a.frag", "void main() {}", GLISTEN_NUL_TERMINATED, 0};
    const glisten_source nameless = {NULL, "", 0, 0}, textless = {"a.frag", NULL, 9, 0}, of_stage_9 = {"a.frag", "", 0, 9};
    const glisten_source no_text = {"a.frag", "\xff", 1, 0}, of_no_stage = {"a.txt", "", 0, 0};
    EXPECT(glisten_compile(NULL, &source, 1, &program) == GLISTEN_STATUS_ARGUMENT && program == NULL);
    EXPECT(glisten_compile(compiler, NULL, 1, &program) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(glisten_compile(compiler, &source, 0, &program) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(glisten_compile(compiler, &source, SIZE_MAX, &program) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(glisten_compile(compiler, &source, 1, NULL) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(glisten_compile(compiler, &nameless, 1, &program) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(glisten_compile(compiler, &textless, 1, &program) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(glisten_compile(compiler, &no_text, 1, &program) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(strstr(glisten_last_error(), "UTF-8"));
    EXPECT(glisten_compile(compiler, &of_stage_9, 1, &program) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(glisten_compile(compiler, &of_no_stage, 1, &program) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(glisten_compiler_set(compiler, "clip-y", "1") == GLISTEN_STATUS_ARGUMENT);
    EXPECT(strstr(glisten_last_error(), "clip-z"));
    EXPECT(glisten_compiler_define(compiler, "1A", NULL) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(glisten_compiler_define(NULL, "A", NULL) == GLISTEN_STATUS_ARGUMENT);
    EXPECT(glisten_blob_data(NULL) == NULL && glisten_blob_size(NULL) == 0 && glisten_picture_width(NULL) == 0);
    EXPECT(glisten_program_diagnostic_count(NULL) == 0 && !glisten_program_has_stage(NULL, 7));
    glisten_blob_free(NULL);
    glisten_program_free(NULL);
    glisten_scene_free(NULL);
    glisten_picture_free(NULL);
    glisten_compiler_free(NULL);
}

int main(void) {
    EXPECT(glisten_abi_version() == GLISTEN_ABI_VERSION);
    int asked = 0;
    glisten_compiler *compiler = glisten_compiler_new();
    CHECK(glisten_compiler_define(compiler, "SHADE", "0.25"));
    CHECK(glisten_compiler_set(compiler, "window-origin", "lower-left"));
    CHECK(glisten_compiler_set_include(compiler, include, &asked, true));
    glisten_program *program = compiled(compiler);
    EXPECT(asked == 1);
    show_code(program);
    show_errors(compiler);
    draw(compiler);
    upgrade(compiler);
    misuse(compiler);
    glisten_compiler_free(compiler);
    show_code(program); /* A program outlives its compiler. */
    glisten_program_free(program);
    printf("glisten %s: all is well\n", glisten_version());
    return 0;
}
