// Compiles variants of a program to SPIR-V with libglslang in one process, on several threads, as `glslangValidator -G100
// --aml --amb` does in a process for each: `variants THREADS OUTPUT VERTEX FRAGMENT`. Standard input has a line for each
// variant: its macros as `NAME=VALUE`, with blanks between them. Writes each stage to a file of OUTPUT and ends with status 1 if one
// is rejected. Included files are looked for in the working folder.
//
// Built and run by benches/permutations.rs; needs Debian's glslang-dev.
#include <glslang/SPIRV/GlslangToSpv.h>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace {

std::string text_of(const std::string& path)
{
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

// The files of the working folder, each read once.
class Files : public glslang::TShader::Includer {
public:
    IncludeResult* includeLocal(const char* name, const char*, size_t) override
    {
        auto found = texts.find(name);
        if (found == texts.end())
            found = texts.emplace(name, text_of(name)).first;
        return found->second.empty() ? nullptr : new IncludeResult(name, found->second.data(), found->second.size(), nullptr);
    }
    void releaseInclude(IncludeResult* result) override { delete result; }

private:
    std::map<std::string, std::string> texts;
};

// The lines of `-D` options.
std::string preamble_of(const std::string& line)
{
    std::string lines = "#extension GL_GOOGLE_include_directive : require\n", word;
    std::stringstream words(line);
    while (words >> word) {
        size_t equals = word.find('=');
        lines += "#define " + word.substr(0, equals) + " " + (equals == std::string::npos ? "" : word.substr(equals + 1)) + "\n";
    }
    return lines;
}

bool compile(const std::string texts[2], const std::string& preamble, Files& files, const std::string& output)
{
    const EShLanguage stages[] = {EShLangVertex, EShLangFragment};
    glslang::TProgram program;
    // The program refers to its shaders until it is gone.
    glslang::TShader vertex(stages[0]), fragment(stages[1]);
    glslang::TShader* shaders[] = {&vertex, &fragment};
    for (int i = 0; i < 2; ++i) {
        const char* text = texts[i].c_str();
        shaders[i]->setStrings(&text, 1);
        shaders[i]->setPreamble(preamble.c_str());
        shaders[i]->setAutoMapLocations(true);
        shaders[i]->setAutoMapBindings(true);
        shaders[i]->setEnvInput(glslang::EShSourceGlsl, stages[i], glslang::EShClientOpenGL, 100);
        shaders[i]->setEnvClient(glslang::EShClientOpenGL, glslang::EShTargetOpenGL_450);
        shaders[i]->setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_0);
        if (!shaders[i]->parse(GetDefaultResources(), 110, false, EShMsgSpvRules, files)) {
            std::fputs(shaders[i]->getInfoLog(), stderr);
            return false;
        }
        program.addShader(shaders[i]);
    }
    if (!program.link(EShMsgSpvRules) || !program.mapIO()) {
        std::fputs(program.getInfoLog(), stderr);
        return false;
    }
    for (int i = 0; i < 2; ++i) {
        std::vector<unsigned int> words;
        glslang::GlslangToSpv(*program.getIntermediate(stages[i]), words);
        std::ofstream file(output + (i ? ".frag.spv" : ".vert.spv"), std::ios::binary);
        file.write(reinterpret_cast<const char*>(words.data()), std::streamsize(4 * words.size()));
        if (!file)
            return false;
    }
    return true;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 5)
        return 2;
    const std::string texts[] = {text_of(argv[3]), text_of(argv[4])};
    std::vector<std::string> variants;
    for (std::string line; std::getline(std::cin, line);)
        variants.push_back(line);
    glslang::InitializeProcess();
    std::atomic<size_t> next{0};
    std::atomic<bool> is_sound{true};
    std::vector<std::thread> threads;
    for (int number = 0; number < std::atoi(argv[1]); ++number)
        threads.emplace_back([&] {
            Files files;
            for (size_t index; (index = next++) < variants.size();)
                if (!compile(texts, preamble_of(variants[index]), files, std::string(argv[2]) + "/" + std::to_string(index)))
                    is_sound = false;
        });
    for (auto& thread : threads)
        thread.join();
    glslang::FinalizeProcess();
    return is_sound ? 0 : 1;
}
