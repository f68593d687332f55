//! The fixed-function pipeline end to end: derived state, sides, clip planes, and the stages that draws do not name.

use crate::cli::{Folder, code, err, out};
use crate::drawing::{complaint, from_disk, from_texts, gpu, reference, strict};
use crate::support::{files_with, root};
use glisten::scene::{MemoryFiles, Scene, load};
use glisten_front::hir::Stage;
use glisten_reference::Precision;

fn draws(scene: &Scene) -> Vec<[f64; 4]> {
    reference(scene, Precision::F64).attachments.into_iter().next().expect("an attachment")
}

#[test]
fn scenes_of_the_fixtures_are_the_same_on_the_gpu() {
    let gpu = gpu();
    for path in files_with(&root().join("fixtures/fixed_function"), "toml") {
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let found = complaint(&format!("fixed_{name}"), &gpu, &from_disk(&path), &strict());
        assert_eq!(found, None);
    }
}

#[cfg(feature = "gl")]
#[test]
fn opengl_draws_the_same_by_its_own_pipeline() {
    let Ok(gl) = glisten_gl::Gl::new() else { return };
    for path in files_with(&root().join("fixtures/fixed_function"), "toml") {
        let scene = from_disk(&path);
        let picture = gl.render(&scene).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let expected = draws(&scene);
        let drawn = picture.attachments.first().expect("an attachment");
        let far = |(a, b): (&[f64; 4], &[f64; 4])| a.iter().zip(b).any(|(a, b)| (a - b).abs() > 1e-4);
        let wrong = expected.iter().zip(drawn).filter(|pair| far(*pair)).count();
        // Edges may be elsewhere by a rounding.
        assert!(wrong <= 2, "{}: {wrong} pixels differ", path.display());
    }
}

/// A square of one color by a program of 1.20.
fn square(vertex: &str, fragment: &str, keys: &str, tables: &str) -> Scene {
    let scene = format!(
        "[framebuffer]\nwidth = 2\nheight = 2\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nprimitive = \
         \"triangle_strip\"\n{keys}\n[draw.attributes]\ngl_Vertex = {{ size = 2, values = [-1, -1, 1, -1, -1, 1, 1, 1] \
         }}\n{tables}\n"
    );
    from_texts([("a.toml", &scene), ("a.vert", vertex), ("a.frag", fragment)])
}

fn color(scene: &Scene) -> [f64; 4] {
    draws(scene)[0].map(|channel| (channel * 1e4).round() / 1e4)
}

const PASS: &str = "void main() { gl_Position = gl_Vertex; gl_FrontColor = vec4(2.0, 0.25, -1.0, 1.0);\n\
                    gl_BackColor = vec4(0.0, 0.5, 0.75, 1.0); }";
const SHOW: &str = "void main() { gl_FragColor = gl_Color; }";

#[test]
fn colors_are_clamped_unless_the_scene_says_otherwise() {
    assert_eq!(color(&square(PASS, SHOW, "", "")), [1.0, 0.25, 0.0, 1.0]);
    assert_eq!(color(&square(PASS, SHOW, "clamp_vertex_color = false", "")), [2.0, 0.25, -1.0, 1.0]);
    let early = PASS.replace("}", "if (gl_Vertex.x < 9.0) return; gl_FrontColor = vec4(0.0); }");
    assert_eq!(color(&square(&early, SHOW, "", "")), [1.0, 0.25, 0.0, 1.0], "before each return");
}

#[test]
fn the_side_decides_the_color_only_if_that_is_on() {
    let back = "front_face = \"cw\"";
    assert_eq!(color(&square(PASS, SHOW, back, "")), [1.0, 0.25, 0.0, 1.0]);
    let on = "vertex_program_two_side = true";
    assert_eq!(color(&square(PASS, SHOW, on, "")), [1.0, 0.25, 0.0, 1.0]);
    assert_eq!(color(&square(PASS, SHOW, &format!("{back}\n{on}"), "")), [0.0, 0.5, 0.75, 1.0]);
    let in_initializer = "vec4 c = gl_Color; void main() { gl_FragColor = c; }";
    assert_eq!(color(&square(PASS, in_initializer, &format!("{back}\n{on}"), "")), [0.0, 0.5, 0.75, 1.0]);
    let front_only = "void main() { gl_Position = gl_Vertex; gl_FrontColor = vec4(0.5); }";
    assert_eq!(color(&square(front_only, SHOW, &format!("{back}\n{on}"), "")), [0.5; 4], "there is no other color");
}

#[test]
fn clip_planes_clip_by_the_clip_vertex() {
    let vertex = "void main() { gl_Position = gl_Vertex; gl_FrontColor = vec4(1.0); gl_ClipVertex = gl_Vertex * 2.0; }";
    let planes = "[draw.uniforms]\n\"gl_ClipPlane[0]\" = [1, 0, 0, 0]\n\"gl_ClipPlane[1]\" = [0, 1, 0, 0.2]";
    let covered = |planes_on: u32| {
        let scene = square(vertex, SHOW, &format!("clip_distances = {planes_on}"), planes);
        reference(&scene, Precision::F64).covered
    };
    assert_eq!(covered(0), [true; 4]);
    assert_eq!(covered(1), [false, true, false, true]);
    assert_eq!(covered(2), [false, true, false, false]);
}

#[test]
fn what_a_scene_sets_decides_what_is_derived() {
    let show = |what: &str, tables: &str| {
        let vertex = format!("void main() {{ gl_Position = gl_Vertex; gl_FrontColor = {what}; }}");
        color(&square(&vertex, SHOW, "", tables))
    };
    // The program does not read the matrix itself.
    let matrix = "[draw.uniforms]\ngl_ModelViewMatrix = [2,0,0,0, 0,4,0,0, 0,0,8,0, 0,0,0,1]";
    assert_eq!(show("vec4(gl_NormalMatrix * vec3(1.0), 1.0)", matrix), [0.5, 0.25, 0.125, 1.0]);
    assert_eq!(show("gl_ModelViewMatrixInverse * vec4(1.0)", matrix), [0.5, 0.25, 0.125, 1.0]);
    let own = format!("{matrix}\ngl_NormalMatrix = [0.1,0,0, 0,0.2,0, 0,0,0.3]");
    assert_eq!(show("vec4(gl_NormalMatrix * vec3(1.0), 1.0)", &own), [0.1, 0.2, 0.3, 1.0], "its own value");
    let fog = "[draw.uniforms]\n\"gl_Fog.end\" = 5.0";
    assert_eq!(show("vec4(gl_Fog.scale)", fog), [0.2; 4]);
    let role = "[draw.transform]\nscale = 2\n[draw.matrices]\ngl_ModelViewMatrix = \"model\"";
    assert_eq!(show("vec4(gl_ModelViewMatrixInverse[0][0])", role), [0.5; 4]);
    let material = "[draw.material]\ndiffuse = [0.5, 0.25, 1.0]\nambient = [0, 0, 0]";
    assert_eq!(show("gl_FrontLightProduct[0].diffuse", material), [0.5, 0.25, 1.0, 1.0]);
    assert_eq!(show("gl_BackLightModelProduct.sceneColor", material), [0.0, 0.0, 0.0, 1.0]);
    assert_eq!(show("gl_Color * 0.5 + vec4(gl_Normal, 1.0) * 0.25", ""), [0.5, 0.5, 0.75, 0.75], "current values");
}

#[test]
fn mistakes_in_the_state_are_told() {
    let messages = |tables: &str| {
        let scene = format!(
            "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n[draw.attributes]\ngl_Vertex = {{ size = 2, values = \
             [-1, -1, 1, -1, -1, 1] }}\n{tables}\n"
        );
        let lit = PASS.replace("vec4(2.0, 0.25, -1.0, 1.0)", "gl_FrontLightModelProduct.sceneColor");
        let files = MemoryFiles::new([("a.toml", scene.as_str()), ("a.vert", &lit), ("a.frag", SHOW)]);
        let loaded = load("a.toml", &files, &crate::support::compiler());
        loaded.diagnostics.iter().map(|found| found.message.clone()).collect::<Vec<_>>().join("; ")
    };
    let wrong = messages("[draw.uniforms]\n\"gl_LightSource[9].diffuse\" = [1, 1, 1, 1]");
    assert!(wrong.contains("no state `gl_LightSource[9].diffuse`"), "{wrong}");
    let wrong = messages("[draw.uniforms]\n\"gl_Fog.color\" = [1, 1, 1]");
    assert!(wrong.contains("`gl_Fog.color` takes 4 numbers, not 3"), "{wrong}");
    let combining = |keys: &str| {
        let scene = format!(
            "[[draw]]\nvertex = \"a.vert\"\n[draw.attributes]\ngl_Vertex = {{ size = 2, values = [-1, -1, 1, -1, -1, 1] }}\n\
             [draw.fixed_function]\nunits = [{{ mode = \"combine\", {keys} }}]\n"
        );
        let files = MemoryFiles::new([("a.toml", scene.as_str()), ("a.vert", PASS)]);
        let loaded = load("a.toml", &files, &crate::support::compiler());
        loaded.diagnostics.iter().map(|found| found.message.clone()).collect::<Vec<_>>().join("; ")
    };
    assert!(combining("rgb_scale = 3").contains("`rgb_scale` is 1, 2 or 4"));
    assert!(combining("combine_alpha = \"dot3_rgb\"").contains("`combine_alpha` cannot be `dot3_rgb`"));
    assert!(combining("operand_alpha = [\"src_color\"]").contains("`operand_alpha` cannot be `src_color`"));
    let crossed = combining("combine_rgb = \"replace\", source_rgb = [\"texture3\"]");
    assert!(crossed.contains("the combiner reads `texture3`"), "{crossed}");
    let wrong = messages("[draw.uniforms]\ngl_FogColor = [1, 1, 1]");
    assert!(wrong.contains("gl_FogColor"), "{wrong}");
    let wrong = messages("[draw.fixed_function]\nlocal_view = true");
    assert!(wrong.contains("is for a draw with one stage"), "{wrong}");
}

#[test]
fn a_stage_alone_is_completed_if_its_language_has_the_pipeline() {
    let lone = |text: &str| {
        let scene = "[[draw]]\nfragment = \"a.frag\"\n[draw.attributes]\ngl_Vertex = { size = 2, values = [-1, -1, 1, -1, -1, 1] }\n\
                     gl_Color = { size = 3, values = [1, 0, 0, 1, 0, 0, 1, 0, 0] }\n";
        load("a.toml", &MemoryFiles::new([("a.toml", scene), ("a.frag", text)]), &crate::support::compiler())
    };
    let old = lone(SHOW).scene.expect("it is complete");
    let fixed = old.draws[0].fixed.as_ref().expect("it has the state");
    assert_eq!(fixed.generated.as_ref().map(|made| made.0), Some(Stage::Vertex));
    assert_eq!(color(&old), [0.0, 0.0, 0.0, 1.0], "the upper left corner is not covered");
    let core = lone("#version 150\nout vec4 c; void main() { c = vec4(1.0); }");
    let found: Vec<&str> = core.diagnostics.iter().map(|found| found.message.as_str()).collect();
    assert!(core.scene.is_none() && found.contains(&"a draw names its vertex shader"), "{found:?}");
    let broken = lone("void main() { gl_FragColor = nothing; }");
    let found: Vec<&str> = broken.diagnostics.iter().map(|found| found.message.as_str()).collect();
    assert!(found.iter().any(|message| message.contains("`nothing`")), "{found:?}");
}

#[test]
fn the_command_writes_stages_that_compile() {
    let folder = Folder::new(&[]);
    let switches = [
        &["--lights", "8", "--local-viewer", "--two-side", "--separate-specular", "--normals", "rescale"][..],
        &["--lights", "1", "--color-material", "ambient_and_diffuse", "--fog", "exp2", "--unit", "decal:2d:sphere_map"],
        &[
            "--color-sum",
            "--fog",
            "linear",
            "--fog-source",
            "coordinate",
            "--unit",
            "add:1d",
            "--unit",
            "blend:cube:normal_map",
        ],
        &["--point-attenuation", "--clip", "--unit", "replace:3d:eye_linear", "--unit", "modulate"],
    ];
    for (index, switches) in switches.iter().enumerate() {
        for version in ["120", "150"] {
            let into = format!("{index}_{version}");
            let written = folder.run(&[&["fixed-function", "--version", version, "-o", &into], *switches].concat());
            assert_eq!(code(&written), 0, "{}", err(&written));
            let checked =
                folder.run(&["compile", &format!("{into}/fixed.vert"), &format!("{into}/fixed.frag"), "-o", "out"]);
            assert_eq!(code(&checked), 0, "{switches:?}: {}", err(&checked));
        }
    }
    let fragment = folder.run(&["fixed-function", "--stage", "fragment", "--unit", "add"]);
    assert!(
        out(&fragment).starts_with("#version 120\n") && !out(&fragment).contains("ftransform"),
        "{}",
        out(&fragment)
    );
    let scene = root().join("fixtures/fixed_function/lone_vertex.toml").to_string_lossy().into_owned();
    let of_scene = folder.run(&["fixed-function", &scene]);
    assert!(out(&of_scene).contains("texel0") && out(&of_scene).contains("gl_Fog"), "{}", out(&of_scene));
    let both = root().join("fixtures/fixed_function/two_side.toml").to_string_lossy().into_owned();
    let complete = folder.run(&["fixed-function", &both]);
    assert_eq!(code(&complete), 1, "{}", err(&complete));
    assert_eq!(code(&folder.run(&["fixed-function", "--unit", "shine"])), 2);
    assert_eq!(code(&folder.run(&["fixed-function", &scene, "--lights", "2"])), 2);
}

#[test]
fn specialized_scenes_draw_the_same() {
    for path in files_with(&root().join("fixtures/fixed_function"), "toml") {
        let (folder, name) = (Folder::new(&[]), path.file_name().expect("a name").to_string_lossy().into_owned());
        let output = folder.run(&["specialize", &path.to_string_lossy(), "-o", "new"]);
        assert_eq!(code(&output), 0, "{name}: {}", err(&output));
        let residual = from_disk(folder.path("new").join(&name));
        // Known operands are evaluated in f32, as the reference with that precision does.
        let draws = |scene: &Scene| reference(scene, Precision::F32).attachments;
        assert!(draws(&from_disk(&path)) == draws(&residual), "{name}");
    }
}

#[test]
fn geometry_shaders_clamp_before_each_vertex() {
    let text = "#version 150 compatibility\nlayout(points) in; layout(points, max_vertices = 2) out;\nvoid main() { gl_FrontColor = \
                vec4(2.0); gl_ClipVertex = gl_in[0].gl_Position; EmitVertex(); gl_FrontColor = vec4(-1.0); EmitVertex(); }\n";
    let options = glisten::Options {
        fixed: glisten_front::link::FixedState { clip_planes: 1, ..Default::default() },
        ..glisten::Options::default()
    };
    let source = glisten::Source { name: "a.geom".into(), text: text.into(), stage: Stage::Geometry };
    let vertex = "#version 150 compatibility\nvoid main() { gl_Position = gl_Vertex; }\n";
    let vertex = glisten::Source { name: "a.vert".into(), text: vertex.into(), stage: Stage::Vertex };
    let compilation = glisten::Compiler::new(options).compile(&[vertex, source]);
    let messages: Vec<&str> = compilation.diagnostics.iter().map(|found| found.message.as_str()).collect();
    let program = compilation.program.unwrap_or_else(|| panic!("{messages:?}"));
    let geometry = program.stage(Stage::Geometry).expect("it is there");
    let printed = glisten_front::hir::print(&program.types, geometry);
    assert_eq!(printed.matches("fixed_EmitFixed();").count(), 2, "{printed}");
    assert!(printed.contains("gl_FrontColor = clamp(gl_FrontColor, 0.0, 1.0);"), "{printed}");
    assert!(printed.contains("gl_ClipDistance[0] = dot(gl_ClipPlane[0], fixed_ClipVertex);"), "{printed}");
}
