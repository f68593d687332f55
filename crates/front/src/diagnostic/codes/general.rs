//! Codes for limits, unsupported features, and internal errors of glisten (`E00xx`).

use super::Example::{Fragment, None, Text, Vertex};

codes! {
    NOT_SUPPORTED_YET = "E0001" "not-supported-yet" Error ""
        "The source uses a construct that glisten knows but does not support yet. The message names it. glisten \
         translates nothing rather than translating it incorrectly."
        bad Text("#version 430\nlayout(std430) buffer Data { float values[]; };"), good Text("#version 430\nlayout(std140) uniform Data { float values[64]; };");
    INTERNAL = "E0002" "internal-error" Error ""
        "glisten contradicted itself. This is a bug in glisten and not in the source; please report it with the \
         source."
        bad None, good None;
    TOO_DEEP = "E0003" "nesting-too-deep" Error ""
        "Expressions, blocks and types may nest 256 levels deep. Long chains (`a + b + c`, `else if`) do not count \
         as nesting and may be far longer; as WebAssembly, in a browser or in Node, the stack of the engine ends them at a few thousand."
        bad Text("c = vec4(((...(1.0)...)));   // 300 parentheses"), good Fragment("out vec4 c; void main() { c = vec4(((1.0))); }");
    TOO_LARGE = "E0004" "source-too-large" Error ""
        "A source may have 8 MiB after its includes."
        bad None, good None;
    FILE_NOT_FOUND = "E0010" "file-not-found" Error ""
        "A file that the command line, a scene or an include names does not exist. Paths on the command line are \
         relative to the current folder, paths in a scene to the folder of the scene file."
        bad Text("glisten lint fong.vert"), good Text("glisten lint phong.vert");
    FILE_UNREADABLE = "E0011" "file-unreadable" Error ""
        "A file exists, but the system does not let it be read. The message contains the system's reason."
        bad Text("chmod 000 lit.frag; glisten lint lit.frag"), good Text("chmod 644 lit.frag; glisten lint lit.frag");
    FILE_IS_FOLDER = "E0012" "file-is-folder" Error ""
        "The path is a folder, but a file is required. `lint`, `compile`, `fmt` and some others search folders; the rest does not."
        bad Text("glisten reflect shaders/"), good Text("glisten reflect shaders/phong.vert shaders/phong.frag");
    EMPTY_SOURCE = "E0013" "empty-source" Error "GLSL 1.50 §3.3"
        "The file is empty or contains only white space. A shader has at least a `#version` line and a `main`. An \
         empty file is most often the result of a failed save or download."
        bad Text("glisten lint empty.vert   # a file of 0 bytes"), good Vertex("void main() { gl_Position = vec4(0.0); }");
    BINARY_SOURCE = "E0014" "binary-source" Error "GLSL 1.50 §3.1"
        "The file is not text: it contains NUL bytes, or many bytes that do not occur in text. Compiled SPIR-V, \
         images and UTF-16 text look like that. A single byte that is not UTF-8, or a single control character, is an \
         illegal character (E0103), and legal in comments."
        bad Text("glisten compile lit.vert.spv --stage vertex -o out"), good Vertex("void main() { gl_Position = vec4(0.0); }");
    OTHER_LANGUAGE = "E0018" "other-language" Error ""
        "The text is of another language: WGSL has attributes such as `@vertex`, HLSL has semantics such as `: SV_Position` and \
         `: register(b0)`. Other errors of the text are not reported, because they follow from that."
        bad Vertex("struct Out { float4 position : SV_Position; };\nOut main(float3 p : POSITION) { Out o; o.position = p; return o; }"),
        good Vertex("in vec3 p;\nvoid main() { gl_Position = vec4(p, 1.0); }");
    BAD_CONFIG = "E0015" "bad-configuration" Error ""
        "A `glisten.toml` or a file of `--permutations` is not TOML, or contains a key, a value or a code that glisten does not \
         know."
        bad Text("[lint]\nalow = [\"L0001\"]"), good Text("[lint]\nallow = [\"L0001\"]");
    BAD_HEADER = "E0016" "bad-engine-header" Error ""
        "The engine of the source reads a header in it, such as the JSON of the Interactive Shader Format, and the header \
         is missing or wrong. `--engine` or a `[[source]]` table of `glisten.toml` names the engine."
        bad Text("/*{ \"INPUTS\": [{\"NAME\": \"level\", \"TYPE\": \"number\"}] }*/"),
        good Text("/*{ \"INPUTS\": [{\"NAME\": \"level\", \"TYPE\": \"float\"}] }*/");
    OVER_BUDGET = "E0017" "over-budget" Error ""
        "A shader costs more than `[lint.budgets]` of `glisten.toml` allows: operations of a class on the longest path through a \
         stage, or registers of varyings. `glisten cost` shows where they are. A loop whose rounds nothing limits counts as many \
         as `iterations` of the budget says, or 8."
        bad Text("[lint.budgets]\n\"*.frag\" = { lookups = 1 }   # and the shader has two"),
        good Text("[lint.budgets]\n\"*.frag\" = { lookups = 2 }");
    LONE_STAGE = "W0001" "lone-stage" Warning "OpenGL 3.2 §2.11"
        "A stage is compiled without its partner. The locations of varyings, the uniform block and the bindings are \
         then those of this stage alone. They do not fit another stage that is compiled alone, too. Give both files \
         in one command."
        bad Text("glisten compile phong.vert -o out"), good Text("glisten compile phong.vert phong.frag -o out");
    NOT_CHECKED = "W0002" "not-checked" Note ""
        "`lint` found this file in a folder and did not check it on its own: it has no `#version` line and is not \
         GLSL 1.10, so its version is not known (`--assume-version`, or `assume_version` and `[[source]]` in \
         `glisten.toml`, say it); or it has a `main`, and its name does not tell its stage (`--stage`, or `stage` in a \
         `[[source]]` table, says it); or another file includes it, and it is checked there; or it is in another language. \
         Name the file on the command line to see its errors. `--deny not-checked` makes such a file an error."
        bad Text("glisten lint shaders/"), good Text("glisten lint shaders/ --assume-version 330");
}
