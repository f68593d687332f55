// Times libglslang in process over the shaders named on standard input, one path a line: parse alone, and parse, link and
// SPIR-V, by Vulkan's relaxed rules with automatic locations, as `glslangValidator -V -R --auto-map-locations
// --auto-map-bindings` has it. Prints, for each shader that it accepts, the path and the least microseconds of each.
//
// Built and run by benches/peers.rs; needs Debian's glslang-dev.
#include <glslang/SPIRV/GlslangToSpv.h>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <glslang/Public/ShaderLang.h>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>
#include <glslang/Public/ResourceLimits.h>

namespace {

double microseconds(std::chrono::steady_clock::duration time)
{
    return std::chrono::duration<double, std::micro>(time).count();
}

EShLanguage stage_of(const std::string& path)
{
    char letter = path.empty() ? 'f' : path[path.rfind('.') + 1];
    return letter == 'v' ? EShLangVertex : letter == 'g' ? EShLangGeometry : EShLangFragment;
}

bool compile(const std::string& text, EShLanguage stage, double& parse, double& whole)
{
    auto start = std::chrono::steady_clock::now();
    glslang::TShader shader(stage);
    const char* texts[] = {text.c_str()};
    shader.setStrings(texts, 1);
    shader.setAutoMapLocations(true);
    shader.setAutoMapBindings(true);
    shader.setEnvInput(glslang::EShSourceGlsl, stage, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
    shader.setEnvInputVulkanRulesRelaxed();
    shader.setGlobalUniformBlockName("uniforms");
    shader.setGlobalUniformSet(0);
    shader.setGlobalUniformBinding(0);
    auto rules = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
    if (!shader.parse(GetDefaultResources(), 110, false, rules))
        return false;
    parse = microseconds(std::chrono::steady_clock::now() - start);
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(rules) || !program.mapIO())
        return false;
    std::vector<unsigned int> words;
    glslang::GlslangToSpv(*program.getIntermediate(stage), words);
    whole = microseconds(std::chrono::steady_clock::now() - start);
    return !words.empty();
}

} // namespace

int main(int argc, char** argv)
{
    int repeats = argc > 1 ? std::atoi(argv[1]) : 10;
    glslang::InitializeProcess();
    std::string path;
    while (std::getline(std::cin, path)) {
        std::ifstream file(path);
        std::stringstream text;
        text << file.rdbuf();
        double parse = 1e30, whole = 1e30;
        bool good = true;
        for (int i = 0; good && i < repeats; ++i) {
            double p = 0.0, w = 0.0;
            good = compile(text.str(), stage_of(path), p, w);
            parse = std::min(parse, p);
            whole = std::min(whole, w);
        }
        if (good)
            std::printf("%s\t%.3f\t%.3f\n", path.c_str(), parse, whole);
    }
    glslang::FinalizeProcess();
}
