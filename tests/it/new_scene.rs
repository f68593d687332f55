//! `new-scene`: for programs of each kind, the scene covers pixels, is not one color, keeps the flags, and draws the same by the reference and
//! by a driver.

use crate::cli::{Folder, code, err, out};
use glisten::scene::{DiskFiles, load};
use glisten::{Compiler, Gpu, Options, Picture, RenderOptions, render};
use glisten_gpu::Via;
use std::fs;

/// The pixels of the window on each side.
const SIDE: &str = "48";
/// The share of pixels that a scene covers at least, and the difference between the lightest and the darkest one.
const COVERED: f64 = 0.05;
const CONTRAST: f64 = 0.05;

/// The share of covered pixels, and the largest difference of a channel between them.
fn shown(picture: &Picture) -> (f64, f64) {
    let covered = picture.covered.iter().filter(|covered| **covered).count() as f64 / picture.covered.len() as f64;
    let colors = picture.attachments[0].iter().zip(&picture.covered).filter(|(_, covered)| **covered);
    let colors: Vec<[f64; 4]> = colors.map(|(color, _)| *color).collect();
    let range = |channel: usize| {
        let values = colors.iter().map(|color| color[channel].clamp(0.0, 1.0));
        let (low, high) = values.fold((1.0_f64, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
        high - low
    };
    (covered, (0..3).map(range).fold(0.0, f64::max))
}

/// Writes the scene of a program, draws it by the reference and by a driver, and returns its text.
fn draws(files: &[(&str, &str)], arguments: &[&str]) -> String {
    let bytes: Vec<(&str, &[u8])> = files.iter().map(|(name, text)| (*name, text.as_bytes())).collect();
    let folder = Folder::new(&bytes);
    let made = folder.run(&[&["new-scene", "-o", "a.toml", "--size", SIDE], arguments].concat());
    assert_eq!(code(&made), 0, "{}", err(&made));
    assert!(err(&made).contains("glisten render a.toml -o a.png"), "{}", err(&made));
    let text = fs::read_to_string(folder.path("a.toml")).expect("written");
    let rendered = folder.run(&["render", "a.toml", "-o", "a.png", "--deny", "warnings", "--allow", "W0108"]);
    assert_eq!(code(&rendered), 0, "without a flag: {}\n{text}", err(&rendered));
    let path = folder.path("a.toml").to_string_lossy().into_owned();
    let scene = load(&path, &DiskFiles, &Compiler::new(Options::default())).scene.expect("the library loads it, too");
    let reference = render(&scene, &RenderOptions::default()).expect("it draws");
    let (covered, contrast) = shown(&reference);
    assert!(covered >= COVERED && contrast >= CONTRAST, "{covered} {contrast}: {}\n{text}", err(&made));
    if !text.contains("geometry =") {
        let gpu = Gpu::new(None).expect("there is an adapter");
        let (covered, contrast) = shown(&gpu.render(&scene, Via::Spirv).expect("it draws").picture);
        assert!(covered >= COVERED && contrast >= CONTRAST, "on the GPU: {covered} {contrast}\n{text}");
    }
    text
}

const WHITE: &str =
    "#version 330 core\nout vec4 c;\nin vec3 n;\nvoid main() { c = vec4(normalize(n) * 0.5 + 0.5, 1.0); }\n";

#[test]
fn fixed_function() {
    let vertex = "varying vec3 n, p;\nvoid main() {\n    n = gl_NormalMatrix * gl_Normal;\n    p = vec3(gl_ModelViewMatrix * gl_Vertex);\n    \
        gl_TexCoord[0] = gl_MultiTexCoord0;\n    gl_Position = ftransform();\n}\n";
    let fragment = "varying vec3 n, p;\nuniform sampler2D wood;\nvoid main() {\n    vec3 l = normalize(gl_LightSource[0].position.xyz - p);\n    \
        gl_FragColor = gl_FrontMaterial.diffuse * max(dot(normalize(n), l), 0.0) * texture2D(wood, gl_TexCoord[0].st);\n}\n";
    let text = draws(&[("a.vert", vertex), ("a.frag", fragment)], &["a.vert", "a.frag"]);
    assert!(text.contains("[camera]") && text.contains("[[light]]") && text.contains("mesh ="), "{text}");
    assert!(
        !text.contains("gl_Vertex") && !text.contains("gl_LightSource"),
        "what follows from the scene is not repeated: {text}"
    );
    // One stage alone gets the pipeline's other one.
    let alone = "uniform float depth;\nvoid main() { gl_FragColor = gl_Color * (0.5 + depth); }\n";
    draws(&[("a.frag", alone)], &["a.frag"]);
}

#[test]
fn matrices_come_from_the_camera() {
    let vertex = "#version 120\nattribute vec3 vertexPosition_modelspace;\nattribute vec3 vertexNormal_modelspace;\nuniform mat4 MVP, V, M;\n\
        uniform vec3 LightPosition_worldspace;\nvarying vec3 n, l;\nvoid main() {\n    gl_Position = MVP * vec4(vertexPosition_modelspace, 1.0);\n    \
        l = LightPosition_worldspace - (M * vec4(vertexPosition_modelspace, 1.0)).xyz;\n    n = (V * M * vec4(vertexNormal_modelspace, 0.0)).xyz;\n}\n";
    let fragment = "#version 120\nvarying vec3 n, l;\nvoid main() { gl_FragColor = vec4(vec3(0.1 + max(dot(normalize(n), normalize(l)), 0.0)), 1.0); }\n";
    let text = draws(&[("a.vert", vertex), ("a.frag", fragment)], &["a.vert", "a.frag"]);
    for line in
        ["MVP = \"model_view_projection\"", "V = \"view\"", "M = \"model\"", "position = \"vertexPosition_modelspace\""]
    {
        assert!(text.contains(line), "{line}: {text}");
    }
    let block = "#version 330 core\nin vec3 position;\nuniform Transform { mat4 MVP; } transform;\nout vec3 n;\n\
        void main() { n = position; gl_Position = transform.MVP * vec4(position - vec3(0.0, 0.0, 2.0), 1.0); }\n";
    let text = draws(&[("a.vs", block), ("a.fs", WHITE)], &["a.vs", "a.fs"]);
    assert!(text.contains("[camera]"), "a matrix in a block needs a camera, too: {text}");
    let names = "#version 330 core\nlayout(location = 0) in vec3 aPos;\nlayout(location = 1) in vec3 aNormal;\nuniform mat4 model, view, projection;\n\
        out vec3 n;\nvoid main() { n = mat3(model) * aNormal; gl_Position = projection * view * model * vec4(aPos, 1.0); }\n";
    draws(&[("a.vs", names), ("a.fs", WHITE)], &["a.vs", "a.fs"]);
    let torus = draws(&[("a.vs", names), ("a.fs", WHITE)], &["a.vs", "a.fs", "--mesh", "torus"]);
    assert!(torus.contains("shape = \"torus\""), "{torus}");
    let object = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\nvn 1 0 0\nf 1//1 2//2 3//3\n";
    let file = draws(&[("a.vs", names), ("a.fs", WHITE), ("m/a.obj", object)], &["a.vs", "a.fs", "--mesh", "m/a.obj"]);
    assert!(file.contains("file = \"m/a.obj\""), "{file}");
    let cube = "#version 330 core\nlayout(location = 0) in vec3 aPos;\nuniform mat4 view, projection;\nout vec3 n;\n\
        void main() { n = aPos; gl_Position = (projection * view * vec4(aPos, 1.0)).xyww; }\n";
    draws(&[("sky.vs", cube), ("sky.fs", WHITE)], &["sky.vs", "sky.fs"]);
}

#[test]
fn pictures_in_two_dimensions_fill_the_window() {
    let vertex = "#version 150\nin vec2 position;\nin vec2 uv;\nout vec2 at;\nvoid main() { at = uv; gl_Position = vec4(position, 0.0, 1.0); }\n";
    let fragment = "#version 150\nin vec2 at;\nuniform sampler2D screenTexture;\nuniform vec2 resolution;\nout vec4 c;\n\
        void main() { c = texture(screenTexture, at) * (gl_FragCoord.x / resolution.x); }\n";
    let text = draws(&[("a.vert", vertex), ("a.frag", fragment)], &["a.vert", "a.frag"]);
    assert!(text.contains("resolution = [48.0, 48.0]") && text.contains("triangle_strip"), "{text}");
    // Positions in pixels.
    let vertex = "#version 150\nin vec2 corner;\nuniform vec2 windowSize;\nout vec2 at;\nvoid main() {\n    at = corner / windowSize;\n    \
        gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0);\n}\n";
    let fragment = "#version 150\nin vec2 at;\nout vec4 c;\nvoid main() { c = vec4(at, 0.0, 1.0); }\n";
    draws(&[("a.vert", vertex), ("a.frag", fragment)], &["a.vert", "a.frag"]);
}

#[test]
fn colors_and_numbers_of_vertices() {
    let vertex = "#version 300 es\nin vec3 aPos;\nin vec3 aColor;\nout vec3 color;\nvoid main() { color = aColor; gl_Position = vec4(aPos, 1.0); }\n";
    let fragment = "#version 300 es\nprecision mediump float;\nin vec3 color;\nout vec4 c;\nvoid main() { c = vec4(color, 1.0); }\n";
    draws(&[("a.vert", vertex), ("a.frag", fragment)], &["a.vert", "a.frag"]);
    let strip = "#version 330\nout vec2 at;\nvoid main() {\n    vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n    at = p;\n    \
        gl_Position = vec4(p * 1.6 - 0.8, 0.0, 1.0);\n}\n";
    let fragment = "#version 330\nin vec2 at;\nout vec4 c;\nvoid main() { c = vec4(at, 0.5, 1.0); }\n";
    draws(&[("a.vert", strip), ("a.frag", fragment)], &["a.vert", "a.frag"]);
}

#[test]
fn geometry_stages_get_their_primitive() {
    let vertex = "#version 150\nin vec3 position;\nout vec3 place;\nvoid main() { place = position; gl_Position = vec4(position, 1.0); }\n";
    let geometry = "#version 150\nlayout(points) in;\nlayout(triangle_strip, max_vertices = 3) out;\nin vec3 place[];\nout vec3 n;\nvoid main() {\n    \
        for (int i = 0; i < 3; i++) {\n        n = place[0];\n        gl_Position = gl_in[0].gl_Position + vec4(0.1 * float(i & 1), 0.1 * float(i >> 1), 0.0, 0.0);\n        \
        EmitVertex();\n    }\n    EndPrimitive();\n}\n";
    let text = draws(&[("a.vert", vertex), ("a.geom", geometry), ("a.frag", WHITE)], &["a.vert", "a.geom", "a.frag"]);
    assert!(text.contains("primitive = \"points\"") && text.contains("geometry = \"a.geom\""), "{text}");
}

#[test]
fn a_stage_that_takes_neighbors_gets_them() {
    let vertex = "#version 150\nin vec3 position;\nin vec3 normal;\nuniform mat4 mvp;\nout vec3 side;\n\
        void main() { side = normal; gl_Position = mvp * vec4(position, 1.0); }\n";
    let geometry = "#version 150\nlayout(triangles_adjacency) in;\nlayout(triangle_strip, max_vertices = 3) out;\nin vec3 side[];\nout vec3 n;\nvoid main() {\n    \
        for (int i = 0; i < 6; i += 2) {\n        n = side[i] * 0.5 + side[i + 1] * 0.5;\n        gl_Position = gl_in[i].gl_Position;\n        EmitVertex();\n    }\n    \
        EndPrimitive();\n}\n";
    let text = draws(&[("a.vert", vertex), ("a.geom", geometry), ("a.frag", WHITE)], &["a.vert", "a.geom", "a.frag"]);
    assert!(text.contains("primitive = \"triangles_adjacency\"") && text.contains("mesh ="), "{text}");
}

#[test]
fn flags_stay_in_the_scene() {
    let toy = "#include \"level.glsl\"\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, LEVEL, 1.0) * SCALE; }\n";
    let text = draws(
        &[("toy/tunnel.glsl", toy), ("inc/level.glsl", "#define LEVEL 0.5\n")],
        &["toy/tunnel.glsl", "--engine", "shadertoy", "-I", "inc", "-D", "SCALE=0.75"],
    );
    for line in [
        "engine = \"shadertoy\"",
        "includes = [\"inc\"]",
        "defines = { SCALE = \"0.75\" }",
        "iResolution = [48.0, 48.0, 1.0]",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    let book = "precision mediump float;\nuniform vec2 u_resolution;\nvoid main() { gl_FragColor = vec4(gl_FragCoord.xy / u_resolution, 0.0, 1.0); }\n";
    let text = draws(&[("a.frag", book)], &["a.frag", "--assume-version", "100"]);
    assert!(text.contains("assume_version = \"100\""), "{text}");
}

#[test]
fn engines() {
    let libretro = "#pragma parameter GAIN \"Gain\" 0.75 0.0 2.0 0.05\n#if defined(VERTEX)\nattribute vec4 VertexCoord;\nattribute vec4 TexCoord;\nvarying vec2 at;\n\
        uniform mat4 MVPMatrix;\nvoid main() { at = TexCoord.xy; gl_Position = MVPMatrix * VertexCoord; }\n#elif defined(FRAGMENT)\n\
        varying vec2 at;\nuniform sampler2D Texture;\nuniform vec2 TextureSize;\nuniform float GAIN;\n\
        void main() { gl_FragColor = texture2D(Texture, at + 0.5 / TextureSize) * GAIN; }\n#endif\n";
    let text = draws(&[("a.glsl", libretro)], &["a.glsl", "--engine", "libretro"]);
    assert!(text.contains("GAIN = 0.75"), "{text}");
    let vertex = "#version 150\nin vec3 Position;\nin vec4 Color;\nin vec2 UV0;\nuniform mat4 ModelViewMat;\nuniform mat4 ProjMat;\nout vec4 color;\nout vec2 at;\n\
        void main() { gl_Position = ProjMat * ModelViewMat * vec4(Position, 1.0); color = Color; at = UV0; }\n";
    let fragment = "#version 150\nuniform sampler2D Sampler0;\nuniform vec4 ColorModulator;\nin vec4 color;\nin vec2 at;\nout vec4 fragColor;\n\
        void main() {\n    vec4 c = texture(Sampler0, at) * color * ColorModulator;\n    if (c.a < 0.1) discard;\n    fragColor = c;\n}\n";
    draws(&[("a.vsh", vertex), ("a.fsh", fragment)], &["a.vsh", "a.fsh", "--engine", "minecraft"]);
}

#[test]
fn only_what_is_read_is_written() {
    let vertex =
        "#version 150\nin vec3 position;\nin vec3 unread;\nvoid main() { gl_Position = vec4(position, 1.0); }\n";
    let fragment = "#version 150\nstruct Light { vec3 position; vec3 color; float range; };\nuniform Light lights[2];\nuniform float gain = 0.5;\nuniform float unread;\n\
        out vec4 c;\nvoid main() { c = vec4(lights[0].color * gain * gl_FragCoord.x / 48.0 + lights[1].color * 0.1, 1.0); }\n";
    let text = draws(&[("a.vert", vertex), ("a.frag", fragment)], &["a.vert", "a.frag"]);
    assert!(text.contains("\"lights[1].color\"") && text.contains("# gain"), "{text}");
    assert!(!text.contains("unread") && !text.contains("lights[0].position") && !text.contains("range"), "{text}");
}

#[test]
fn stages_in_any_order_and_two_of_one_stage() {
    let vertex = "#version 150\nin vec3 position;\nvoid main() { gl_Position = vec4(position, 1.0); }\n";
    let fragment = "#version 150\nout vec4 c;\nvoid main() { c = vec4(gl_FragCoord.xy / 48.0, 0.0, 1.0); }\n";
    draws(&[("a.vert", vertex), ("a.frag", fragment)], &["a.frag", "a.vert"]);
    let folder = Folder::new(&[("a.vert", vertex.as_bytes()), ("b.vert", vertex.as_bytes())]);
    let two = folder.run(&["new-scene", "a.vert", "b.vert"]);
    assert!(code(&two) == 2 && err(&two).contains("of one stage"), "{}{}", out(&two), err(&two));
}

/// A vertex shader with a place in the window from 0 to 1, for fragment shaders that say more.
const PLACE: &str = "#version 330\nin vec3 position;\nout vec2 at;\nvoid main() { at = position.xy * 0.5 + 0.5; gl_Position = vec4(position, 1.0); }\n";

/// The text of the scene of a fragment shader with [`PLACE`] before it; `body` is all after the output.
fn draws_body(body: &str) -> String {
    let fragment = format!("#version 330\nin vec2 at;\nout vec4 c;\n{body}\n");
    draws(&[("a.vert", PLACE), ("a.frag", &fragment)], &["a.vert", "a.frag"])
}

/// The remarks of `new-scene` on a program.
fn said(files: &[(&str, &str)]) -> String {
    let bytes: Vec<(&str, &[u8])> = files.iter().map(|(name, text)| (*name, text.as_bytes())).collect();
    let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
    let made = Folder::new(&bytes).run(&[&["new-scene", "-o", "a.toml", "--size", SIDE], &names[..]].concat());
    assert_eq!(code(&made), 0, "{}", err(&made));
    err(&made)
}

#[test]
fn lights_do_not_saturate_a_surface() {
    let vertex = "#version 330\nin vec3 VertexPosition;\nin vec3 VertexNormal;\nuniform vec3 LightIntensity, Kd, Ka, Ks;\nuniform vec4 LightPosition;\n\
        uniform mat4 ModelViewMatrix, MVP;\nuniform mat3 NormalMatrix;\nout vec3 color;\nvoid main() {\n    vec3 n = normalize(NormalMatrix * VertexNormal);\n    \
        vec3 p = (ModelViewMatrix * vec4(VertexPosition, 1.0)).xyz;\n    vec3 l = normalize(LightPosition.xyz - p);\n    \
        vec3 r = reflect(-l, n);\n    color = LightIntensity * (Ka + Kd * max(dot(l, n), 0.0) + Ks * pow(max(dot(r, normalize(-p)), 0.0), 32.0));\n    \
        gl_Position = MVP * vec4(VertexPosition, 1.0);\n}\n";
    let fragment = "#version 330\nin vec3 color;\nout vec4 c;\nvoid main() { c = vec4(color, 1.0); }\n";
    let text = draws(&[("a.vert", vertex), ("a.frag", fragment)], &["a.vert", "a.frag"]);
    assert!(text.contains("LightIntensity = [1.0, 1.0, 1.0]") && text.contains("shape ="), "{text}");
}

#[test]
fn colors_and_pictures_of_one_program_differ() {
    let text = draws_body("uniform vec4 color1, color2;\nvoid main() { c = mix(color1, color2, step(0.5, at.x)); }");
    assert!(text.contains("color1 = [0.8, 0.5, 0.3, 1.0]") && text.contains("color2 = [0.5, 0.3, 0.8, 1.0]"), "{text}");
    draws_body("uniform sampler2D before, after;\nvoid main() { c = abs(texture(before, at) - texture(after, at)); }");
    draws_body(
        "uniform float innerRadius, outerRadius;\nvoid main() { c = vec4(smoothstep(innerRadius, outerRadius, length(at - 0.5))); }",
    );
}

#[test]
fn elements_and_corners_differ() {
    // The two corners of a box, and the colors of a palette.
    draws_body(
        "uniform vec3 boxCorners[2];\nvoid main() { c = vec4(vec3(length(at) / length(boxCorners[1] - boxCorners[0])), 1.0); }",
    );
    draws_body("uniform ivec3 palette[4];\nvoid main() { c = vec4(palette[int(at.x * 3.99)], 255) / 255.0; }");
    draws_body(
        "uniform ivec4 tint;\nuniform ivec4 tintColor;\nvoid main() { c = vec4(at, 0.5, 1.0) * vec4(tintColor) / 255.0 * float(tint.x); }",
    );
    let vertex = "#version 330\nin vec3 position, extra;\nout vec3 side;\nvoid main() { side = extra; gl_Position = vec4(position, 1.0); }\n";
    let fragment = "#version 330\nin vec3 side;\nout vec4 c;\n\
        void main() { float d = min(side.x, min(side.y, side.z)); if (d > fwidth(d)) discard; c = vec4(side, 1.0); }\n";
    draws(&[("a.vert", vertex), ("a.frag", fragment)], &["a.vert", "a.frag"]);
}

#[test]
fn alpha_alone_is_shown_by_blending() {
    let text = draws_body("uniform vec3 glyphColor;\nvoid main() { c = vec4(glyphColor, at.x); }");
    assert!(text.contains("blend = \"alpha\""), "{text}");
    draws_body("uniform sampler2D noiseTable;\nvoid main() { c = vec4(texture(noiseTable, at).aaa, 1.0); }");
}

#[test]
fn textures_that_are_fetched_are_large_enough() {
    let vertex = "#version 150\nin vec3 Position;\nin vec4 Color;\nin ivec2 UV2;\nuniform sampler2D Sampler2;\nuniform mat4 ModelViewMat, ProjMat;\nout vec4 color;\n\
        void main() { color = Color * texelFetch(Sampler2, UV2 / 16, 0); gl_Position = ProjMat * ModelViewMat * vec4(Position, 1.0); }\n";
    let fragment =
        "#version 150\nin vec4 color;\nout vec4 c;\nvoid main() { if (color.a < 0.1) discard; c = color; }\n";
    draws(&[("a.vsh", vertex), ("a.fsh", fragment)], &["a.vsh", "a.fsh", "--engine", "minecraft"]);
}

#[test]
fn numbers_that_hide_the_picture_are_found() {
    draws_body("uniform float darknessFactor;\nvoid main() { c = vec4(at, 0.0, 1.0) * (1.0 - darknessFactor); }");
    draws_body("uniform float zork;\nvoid main() { if (zork < 5.0) discard; c = vec4(at, 0.0, 1.0); }");
    draws_body(
        "uniform float zork, zark;\nvoid main() { c = vec4(at, 0.0, 1.0) * step(9.0, zork) * step(zark, 0.6); }",
    );
}

#[test]
fn depths_and_shadows() {
    let text = draws_body(
        "uniform float near, far;\nuniform sampler2DShadow shadowMap;\nvoid main() {\n    float z = 2.0 * near * far / (far + near - (2.0 * at.x - 1.0) * (far - near));\n    \
         c = vec4(vec3(z / far) * (0.5 + 0.5 * texture(shadowMap, vec3(at, 0.5))), 1.0);\n}",
    );
    assert!(text.contains("near = 0.5") && text.contains("far = 20.0"), "{text}");
    draws_body(
        "uniform sampler2DShadow shadowMap;\nvoid main() { if (texture(shadowMap, vec3(at, 0.5)) > 0.1) discard; c = vec4(at, 0.0, 1.0); }",
    );
    let depth = "void main() { gl_FragColor = vec4(vec3(gl_FragCoord.z), 1.0); }\n";
    let vertex = "void main() { gl_Position = ftransform(); }\n";
    draws(&[("a.vert", vertex), ("a.frag", depth)], &["a.vert", "a.frag"]);
}

#[test]
fn a_vertex_shader_alone_shows_its_texture_coordinates() {
    let vertex = "void main() { gl_TexCoord[0] = gl_MultiTexCoord0; gl_Position = ftransform(); }\n";
    let text = draws(&[("a.vert", vertex)], &["a.vert"]);
    assert!(text.contains("texture0 =") && text.contains("mode = \"replace\""), "{text}");
}

#[test]
fn a_vertex_shader_alone_shows_its_varyings() {
    let modern = "#version 330\nin vec4 position;\nuniform mat4 projMat;\nuniform mat4 modelViewMat;\nout vec3 sum;\n\
        flat out int kind;\nout mat2 m;\nnoperspective out float far[2];\nvoid main() { vec4 p = modelViewMat * position; \
        gl_Position = projMat * p; sum = p.xyz; kind = gl_VertexID % 3; m = mat2(p.x); far[0] = length(p); far[1] = 1.0; }\n";
    draws(&[("modern.vert", modern)], &["modern.vert"]);
    let es = "attribute vec4 position;\nvarying vec2 uv;\nvoid main() { gl_Position = position; uv = position.xy; }\n";
    draws(&[("es.vert", &format!("#version 100\n{es}"))], &["es.vert"]);
    let es = "#version 300 es\nin vec4 position;\nflat out ivec2 k;\nout vec2 uv;\n\
        void main() { gl_Position = position; uv = position.xy; k = ivec2(1, 2); }\n";
    draws(&[("es.vert", es)], &["es.vert"]);
}

/// The stage that is written repeats what the language wants in both, and has the version of ES that the other one has.
#[test]
fn a_stage_that_is_written_links() {
    let uv = "= position.xy * 0.5 + 0.5;";
    for (version, out) in [
        ("330", "smooth out vec2 k"),
        ("150", "centroid out vec2 k"),
        ("330", "invariant smooth centroid out vec2 k"),
        ("410", "layout(location = 3) out vec2 k"),
        ("450", "layout(location = 2, component = 1) out vec2 k"),
        ("310 es", "layout(location = 1) out vec2 k"),
        ("320 es", "out vec2 k"),
    ] {
        let text = format!(
            "#version {version}\nin vec4 position;\n{out};\nvoid main() {{ gl_Position = position; k {uv} }}\n"
        );
        draws(&[("a.vert", &text)], &["a.vert"]);
    }
    for (version, input, k) in [
        ("120", "centroid varying vec4 k", "k"),
        ("120", "invariant varying vec4 k", "k"),
        ("150", "invariant in vec4 k", "k"),
        ("330", "in V { smooth vec4 k; centroid vec2 m; } v", "v.k"),
        ("420", "layout(location = 3) in vec4 k", "k"),
        ("450", "layout(location = 1) in V { vec4 k; } v", "v.k"),
        ("310 es", "precision highp float;\nlayout(location = 2) in vec4 k", "k"),
        ("320 es", "precision highp float;\nin vec4 k", "k"),
    ] {
        let (out, color) = if version == "120" { ("", "gl_FragColor") } else { ("out vec4 c;", "c") };
        let text = format!("#version {version}\n{input};\n{out}\nvoid main() {{ {color} = {k}; }}\n");
        draws(&[("a.frag", &text)], &["a.frag"]);
    }
}

/// A scene whose pictures would need two formats is not written.
#[test]
fn outputs_of_two_kinds_have_no_scene() {
    let fragment = "#version 150\nout vec4 a;\nout ivec2 b;\nvoid main() { a = vec4(1.0); b = ivec2(1); }\n";
    let folder = Folder::new(&[("a.frag", fragment.as_bytes())]);
    let made = folder.run(&["new-scene", "a.frag", "-o", "a.toml"]);
    assert_eq!(code(&made), 1);
    assert!(err(&made).contains("`a` (vec4) and `b` (ivec2) need two"), "{}", err(&made));
    assert!(!folder.path("a.toml").exists());
    let picture = folder.run(&["new-scene", "a.frag", "-o", "a.png"]);
    assert!(code(&picture) == 2 && err(&picture).contains("`a.png` is the name of a picture"), "{}", err(&picture));
}

#[test]
fn a_scene_needs_its_folder() {
    let folder = Folder::new(&[("a.frag", WHITE.as_bytes())]);
    let made = folder.run(&["new-scene", "a.frag", "-o", "out dir/s.toml"]);
    assert_eq!((code(&made), err(&made).contains("there is no folder `out dir`")), (2, true), "{}", err(&made));
    assert!(!err(&made).contains("not drawn"), "{}", err(&made));
}

#[test]
fn attributes_without_a_position() {
    let vertex = "#version 150\nin vec2 texCoord;\nin vec3 weightColor;\nuniform sampler2D positions;\nout vec3 color;\n\
        void main() { color = weightColor; gl_Position = vec4(texCoord * 1.8 - 0.9, texture(positions, texCoord).x * 0.1, 1.0); }\n";
    let fragment = "#version 150\nin vec3 color;\nout vec4 c;\nvoid main() { c = vec4(color, 1.0); }\n";
    draws(&[("a.vert", vertex), ("a.frag", fragment)], &["a.vert", "a.frag"]);
}

#[test]
fn a_fragment_shader_alone_gets_all_its_inputs() {
    let fixed =
        "varying vec3 place;\nvoid main() { gl_FragColor = gl_TexCoord[0] * gl_Color * vec4(place.xy, 1.0, 1.0); }\n";
    draws(&[("fixed.frag", fixed)], &["fixed.frag"]);
    let block = "#version 330\nin Data { vec2 at; flat int number; } data;\nin vec2 taps[3];\nout vec4 c;\n\
        void main() { c = vec4(data.at, taps[2].x + float(data.number), 1.0); }\n";
    draws(&[("block.frag", block)], &["block.frag"]);
    let smooth = "#version 330\nsmooth in vec2 at;\nout vec4 c;\nvoid main() { c = vec4(at, 0.0, 1.0); }\n";
    draws(&[("smooth.frag", smooth)], &["smooth.frag"]);
}

#[test]
fn one_color_of_the_program_itself_is_said() {
    let fill = "#version 330\nuniform vec4 tint;\nout vec4 c;\nvoid main() { c = tint; }\n";
    let told = said(&[("a.vert", PLACE), ("a.frag", fill)]);
    assert!(told.contains("in one color: that of the program depends on no varying"), "{told}");
    let none = "#version 330\nvoid main() { }\n";
    let told = said(&[("a.vert", PLACE), ("a.frag", none)]);
    assert!(told.contains("in one color: the program writes none"), "{told}");
}
