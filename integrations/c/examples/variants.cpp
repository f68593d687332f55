// Compiles variants of a program on two threads, and draws a scene of the repository if its path is given.
//
//   c++ -std=c++17 -I. examples/variants.cpp -L../../target/debug -lglisten -lpthread -o variants

#include "glisten.hpp"

#include <cstdio>
#include <future>
#include <map>

namespace {

const char *const VERTEX = R"(#version 150
in vec4 position;
void main() { gl_Position = position; }
)";
const char *const FRAGMENT = R"(#version 150
#extension GL_ARB_shading_language_include : require
#include "levels.glsl"
uniform vec4 tint;
out vec4 color;
void main() { color = tint * LEVEL_OF(VARIANT); }
)";

void expect(bool holds, const char *what) {
    if (!holds) throw std::runtime_error(what);
}

std::string variant(int number) {
    glisten::Compiler compiler;
    compiler.define("VARIANT", std::to_string(number) + ".0").set("glsl-version", "450").bind_output("color", 0);
    compiler.include(
        [](std::string_view path, bool, std::string_view) -> std::optional<std::string> {
            if (path != "levels.glsl") return std::nullopt;
            return "#define LEVEL_OF(x) (x)\n";
        },
        true);
    const glisten::Program program = compiler.compile({{"a.vert", VERTEX}, {"a.frag", FRAGMENT}});
    expect(program.diagnostics().empty(), "the program has no diagnostics");
    expect(program.spirv(GLISTEN_STAGE_FRAGMENT).at(0) == 0x07230203, "SPIR-V begins with its magic number");
    return program.emit(GLISTEN_STAGE_FRAGMENT, GLISTEN_TARGET_GLSL);
}

void errors() {
    glisten::Compiler compiler;
    compiler.include([](std::string_view, bool, std::string_view) -> std::optional<std::string> {
        throw std::runtime_error("this host has no files");
    });
    const glisten::Program program = compiler.lint({{"a.frag", FRAGMENT}});
    const std::string text = program.diagnostics(GLISTEN_FORMAT_HUMAN);
    expect(text.find("this host has no files") != std::string::npos, "an exception becomes a diagnostic");
    try {
        program.emit(GLISTEN_STAGE_FRAGMENT, GLISTEN_TARGET_WGSL);
        expect(false, "a program with errors has no code");
    } catch (const glisten::Error &error) {
        expect(error.status() == GLISTEN_STATUS_CONTENT, "the status says whose fault it is");
    }
    try {
        compiler.set("clip-z", "sideways");
        expect(false, "no option takes any word");
    } catch (const glisten::Error &error) {
        std::printf("%s\n", error.what());
    }
}

void upgrade() {
    const std::vector<glisten::Source> old = {{"old.vert", "void main() { gl_Position = ftransform(); }\n"}};
    const glisten::Upgraded upgraded = glisten::Compiler().upgrade(old, "330");
    expect(upgraded.texts.at(0).find("modelViewProjectionMatrix * vertex") != std::string::npos, "built-in names are replaced");
    expect(upgraded.notes.size() == 1, "the host has to provide them");
    try {
        glisten::Compiler().upgrade({{"old.vert", "void main() { gl_ClipVertex = gl_Vertex; }\n"}});
        expect(false, "some names have no counterpart");
    } catch (const glisten::Error &error) {
        expect(error.status() == GLISTEN_STATUS_CONTENT, "the status says whose fault it is");
    }
}

}  // namespace

int main(int count, char **arguments) try {
    std::map<int, std::string> codes;
    std::future<std::string> other = std::async(std::launch::async, variant, 2);
    codes[1] = variant(1);
    codes[2] = variant(2);
    expect(codes[2] == other.get(), "the same input has the same code on every thread");
    expect(codes[1] != codes[2], "variants differ");
    errors();
    upgrade();
    if (count > 1) {
        const glisten::Scene scene = glisten::Compiler().load(arguments[1]);
        const glisten::Picture picture = scene.render();
        double sum = 0;
        for (const float channel : picture.floats()) sum += channel;
        std::printf("%u x %u pixels, sum %.3f\n", picture.width(), picture.height(), sum);
        expect(sum > 0, "something was drawn");
    }
    std::printf("all is well\n");
    return 0;
} catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
