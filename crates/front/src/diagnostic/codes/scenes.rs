//! Codes for scene files and for running them (`E09xx`).

use super::Example::Text;

codes! {
    SCENE_FILE_UNREADABLE = "E0901" "unreadable-scene-file" Error ""
        "A scene, or a shader, mesh or image that it names, is missing, a folder, or cannot be read. Paths in a scene are \
         relative to the scene file."
        bad Text("[[draw]]\nvertex = \"no such file.vert\""), good Text("[[draw]]\nvertex = \"triangle.vert\"");
    SCENE_SYNTAX = "E0902" "malformed-scene" Error ""
        "The scene is not TOML: an empty or binary file, a missing bracket or quote, a key given twice."
        bad Text("[framebuffer\nwidth = 128"), good Text("[framebuffer]\nwidth = 128");
    SCENE_UNKNOWN_KEY = "E0903" "unknown-scene-key" Error ""
        "The scene has an unknown key. If it were silently ignored, a misspelled key would draw a different \
         picture."
        bad Text("[framebuffer]\nwidht = 128"), good Text("[framebuffer]\nwidth = 128");
    SCENE_WRONG_TYPE = "E0904" "wrong-scene-value-type" Error ""
        "A key of the scene has a value of the wrong type: text instead of a number, one number instead of a list, \
         a fraction instead of an integer."
        bad Text("[framebuffer]\nwidth = \"128\""), good Text("[framebuffer]\nwidth = 128");
    SCENE_WRONG_VALUE = "E0905" "wrong-scene-value" Error ""
        "A key of the scene has a value of the right type that is not allowed: an unknown primitive, factor or \
         format, or a number out of range."
        bad Text("[[draw]]\nprimitive = \"quads\""), good Text("[[draw]]\nprimitive = \"triangles\"");
    SCENE_MISSING_KEY = "E0906" "missing-scene-key" Error ""
        "The scene lacks a key that has no default, or a number that nothing else determines, such as the number of \
         vertices of a draw without attributes."
        bad Text("[[draw]]\nfragment = \"a.frag\""), good Text("[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"");
    SCENE_UNKNOWN_NAME = "E0907" "undeclared-scene-name" Error ""
        "The scene sets an attribute, uniform or sampler that the program does not declare. A name that is declared \
         but not used is accepted."
        bad Text("[draw.uniforms]\nmodel_viev = [..]"), good Text("[draw.uniforms]\nmodel_view = [..]");
    SCENE_WRONG_SIZE = "E0908" "wrong-scene-data-size" Error ""
        "A list in the scene has the wrong number of elements: vertex data that is not a multiple of its size, a \
         matrix with 12 numbers instead of 16, texels that do not fill the texture, an index past the last vertex."
        bad Text("mc = [1, 0, 0]  # a mat4"), good Text("mc = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]");
    SCENE_MISSING_ATTRIBUTE = "E0909" "attribute-without-data" Error "OpenGL 3.2 §2.8"
        "The vertex shader reads an attribute for which the scene has no data, and its value can reach the position or \
         an output."
        bad Text("[draw.attributes]  # and the shader reads `pv`"), good Text("[draw.attributes]\npv = { size = 3, values = [..] }");
    SCENE_WRONG_KIND = "E0910" "contradicting-scene-kind" Error "OpenGL 3.2 §2.7"
        "A `kind` or `integer` in the scene contradicts the declaration in the shader: float data for an `ivec2` \
         input, a 2D texture for a `samplerCube`, a fraction for an `int` uniform."
        bad Text("i = { size = 1, kind = \"float\", values = [1] }  # in int i;"), good Text("i = { size = 1, values = [1] }");
    SCENE_BAD_ASSET = "E0911" "unreadable-mesh-or-image" Error ""
        "A mesh or image that the scene names was read, but its format is not as expected."
        bad Text("mesh = { file = \"cut_off.glb\" }"), good Text("mesh = { file = \"whole.glb\" }");
    SCENE_CANNOT_DRAW = "E0912" "undrawable-scene" Error ""
        "The scene describes an impossible draw: a program without a vertex stage, an output of another type than the \
         framebuffer's numbers, a primitive that the geometry shader does not take, or a framebuffer past the limit. Or a \
         pixel is asked for that its picture has not."
        bad Text("[framebuffer]\nformat = \"rgba32sint\"\n[[draw]]\nfragment = \"lit.frag\"   # out vec4 color;"),
        good Text("[framebuffer]\nformat = \"rgba32float\"\n[[draw]]\nfragment = \"lit.frag\"");
    SCENE_LOOP_BUDGET = "E0913" "endless-loop" Error ""
        "While the CPU reference drew the scene, loops ran more than 16,777,216 instructions for 64 invocations \
         together, or the program reached a call that is longer than that with all the calls that it leads to. The reference \
         gives up rather than hang, and makes no picture."
        bad Text("while (true) {}"), good Text("for (int i = 0; i < 100; ++i) {}");
    SCENE_UNSET_UNIFORM = "W0901" "uniform-without-value" Warning "GLSL 1.50 §4.3.5"
        "The program reads a uniform that has no initializer and that the scene does not list. It is 0, as in OpenGL."
        bad Text("[draw.uniforms]  # and the shader reads `shininess`"), good Text("[draw.uniforms]\nshininess = 32");
    SCENE_UNSET_TEXTURE = "W0902" "sampler-without-texture" Warning "OpenGL 3.2 §3.8.15"
        "The program reads a sampler for which the scene has no texture. Every texel reads as (0, 0, 0, 1), as with \
         an incomplete texture in OpenGL."
        bad Text("[draw.textures]  # and the shader reads `tex`"), good Text("[draw.textures]\ntex = { width = 1, height = 1, values = [1, 1, 1, 1] }");
    SCENE_UNSET_ATTRIBUTE = "W0906" "inactive-attribute-without-data" Warning "OpenGL 3.2 §2.11.3"
        "The vertex shader reads an attribute for which the scene has no data, and nothing that it computes from it can reach \
         a position or an output. It is (0, 0, 0, 1). Where it could reach one, missing data is an error."
        bad Text("[draw.attributes]  # and the shader stores `tangent` in a variable that nothing reads"),
        good Text("[draw.attributes]\ntangent = { size = 3, values = [1, 0, 0] }");
    BOUND_EXPLAINED = "W0905" "bound-explained" Note "Vulkan, Precision of SPIR-V Instructions"
        "`verify` names the operations that contribute most to the bound of the worst pixel: if one of them were \
         exact, the envelope there would be narrower. A GPU may be off by that much. If the bound is wider than you \
         like, rewrite these expressions."
        bad Text("float s = pow(c, 1000.0);"), good Text("float s = c * c;");
    PRECISION_LOST = "W0903" "precision-loss" Note "GLSL 1.50 §4.1.4"
        "Drawing the scene in f32 and f64 side by side shows that this expression loses bits that its operands \
         still had, is not a finite number, or has another outcome in f32. Typical causes are a difference of \
         nearly equal numbers, a power with a large exponent, and a vector too short to normalize. Expressions that \
         only inherit the error are not reported."
        bad Text("float c = 1.0 - cos(x);  // x is small"), good Text("float s = sin(0.5 * x); float c = 2.0 * s * s;");
    UNSTABLE_EXPRESSION = "W0920" "unstable-expression" Warning "GLSL 1.50 §4.1.4"
        "`glisten stability` drew the scene in f32 and in exact arithmetic. The pictures differ, and the difference \
         shrinks if this expression alone is computed exactly. Typical causes are a difference of nearly equal numbers, a \
         power with a large exponent, a vector too short or too long to normalize, an angle that is too large, and a sum over \
         many iterations. The help text says what to write instead, or that the problem is ill-posed: then the exact result \
         itself jumps."
        bad Text("float c = 1.0 - cos(x);  // x is small"), good Text("float s = sin(0.5 * x); float c = 2.0 * s * s;");
    SCENE_WITHOUT_DRAW = "W0908" "scene-without-draw" Warning ""
        "The scene has no draw, so its picture is the clear color everywhere. `verify` has nothing to judge then."
        bad Text("[framebuffer]\nwidth = 128"), good Text("[framebuffer]\nwidth = 128\n[[draw]]\nprogram = \"standard\"");
    NOTHING_COVERED = "W0909" "nothing-covered" Warning ""
        "No fragment of the scene reached a pixel: the picture is the clear color everywhere. Typical causes are triangles \
         without area, a mesh outside the view or behind the camera, culling of the faces that are seen, a depth test that \
         never passes, and a `discard` that always runs."
        bad Text("mesh = { shape = \"plane\", position = \"p\" }  # in vec2 p; the plane has y = 0"),
        good Text("mesh = { shape = \"quad\", position = \"p\" }");
    OUTPUT_WITHOUT_ATTACHMENT = "W0914" "output-without-attachment" Warning "OpenGL 3.2 §4.2.1"
        "A program has more color outputs than the framebuffer has attachments. What it writes to the others is dropped, \
         as OpenGL does."
        bad Text("[framebuffer]\nattachments = 1\n[[draw]]\nfragment = \"two.frag\"   # out vec4 color; out vec4 depth;"),
        good Text("[framebuffer]\nattachments = 2\n[[draw]]\nfragment = \"two.frag\"");
    NAN_IN_PNG = "W0913" "nan-in-png" Warning ""
        "A PNG has no NaN. The picture has some, and each of them is 0 in the file. Typical causes are `0.0 / 0.0`, `sqrt` \
         of a negative number, `pow` of a negative base, and `normalize` of a vector without length. A `.npy` and a `.exr` \
         keep NaN."
        bad Text("color = vec4(sqrt(-1.0));  // and `glisten render scene.toml -o picture.png`"),
        good Text("color = vec4(sqrt(max(x, 0.0)));");
    MESH_NARROWED = "W0910" "narrowed-mesh-data" Note "OpenGL 3.2 §2.8"
        "An attribute has fewer components than the mesh provides, so the last ones are dropped. A `plane`, for \
         example, has y = 0 everywhere: its x and y alone are triangles without area."
        bad Text("mesh = { shape = \"sphere\", position = \"p\" }  # in vec2 p;"),
        good Text("mesh = { shape = \"sphere\", position = \"p\" }  # in vec3 p;");
    SCENE_UNUSED_LIGHT = "W0904" "lights-without-program" Warning ""
        "The scene has lights, a material or a global ambient light, but none of its programs declares the uniforms \
         for them: `light`, `lights`, `material`, `global_ambient` of `<glisten/scene.glsl>`."
        bad Text("[[light]]  # and all draws have `program = \"decal\"`"), good Text("[[light]]\nkind = \"directional\"\ntowards = [0, 1, 0]\n[[draw]]\nprogram = \"standard\"");
    SCENE_UNREAD_KEY = "W0911" "unread-light-or-material-key" Warning ""
        "A light or a material sets a value that none of the programs to which it applies reads, so the key changes \
         nothing: a `specular_model` for a program that has one model, a highlight for the program `lambert`, a \
         member that a shader with `<glisten/scene.glsl>` leaves out. The help names the programs of the library \
         that read it."
        bad Text("material = { specular_model = \"phong\" }  # with program = \"lambert\""),
        good Text("material = { specular_model = \"phong\" }  # with program = \"standard\"");
    MODEL_SIMPLIFIED = "W0912" "simplified-model" Note ""
        "A model from the disk has something that its scene does not show: materials that are missing, a texture in a format \
         that is not read, points or lines. The rest is drawn."
        bad Text("glisten render chair.obj -o chair.png   # and the file that `mtllib` names is not there"), good Text("glisten render chair.obj -o chair.png   # with `chair.mtl`");
}
