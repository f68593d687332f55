//! Layouts as a shader sees them: for random sets of uniforms, every scalar that the runner writes at its reflected
//! offset is read back by lavapipe unchanged, with the SPIR-V and with the WGSL.
//!
//! The test needs a Vulkan software adapter.

use crate::layouts::{declarations, member};
use crate::support::{compiler, fragment_program};
use glisten::scene::{MemoryFiles, Scene};
use glisten_front::hir::{Type, Types};
use glisten_front::link::UniformLeaf;
use glisten_gpu::Via;
use glisten_verify::scene;
use proptest::strategy::{Strategy, ValueTree};

const WIDTH: usize = 64;
const VERTEX: &str = "#version 150\nvoid main() { vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n\
    gl_Position = vec4(p * 4.0 - 1.0, 0.0, 1.0); }\n";

/// A scalar of a uniform: its GLSL expression, and its value.
struct Scalar {
    path: String,
    value: f64,
}

/// The columns and rows of a scalar, vector or matrix.
fn shape(types: &Types, leaf: &UniformLeaf) -> (u32, u32) {
    match types.get(leaf.ty) {
        Type::Vector(_, size) => (1, u32::from(size)),
        Type::Matrix(columns, rows) => (u32::from(columns), u32::from(rows)),
        _ => (1, 1),
    }
}

/// All scalars of a leaf in the order of a scene's numbers, whose values count from `first`.
fn scalars(types: &Types, leaf: &UniformLeaf, first: usize) -> Vec<Scalar> {
    let (columns, rows) = shape(types, leaf);
    let name = leaf.name.replacen("Block.", "block.", 1);
    let is_bool = types.scalar_of(leaf.ty) == Some(glisten_front::hir::Scalar::Bool);
    let mut scalars = Vec::new();
    for element in 0..leaf.array_size.unwrap_or(1) {
        for column in 0..columns {
            for row in 0..rows {
                let mut path = name.clone();
                path += &leaf.array_size.map_or_else(String::new, |_| format!("[{element}]"));
                path += &if columns > 1 { format!("[{column}]") } else { String::new() };
                path += &if rows > 1 { format!("[{row}]") } else { String::new() };
                let number = (first + scalars.len()) as f64;
                scalars.push(Scalar { path, value: if is_bool { number % 3.0 % 2.0 } else { number + 1.0 } });
            }
        }
    }
    scalars
}

/// The declarations, with a `main` that shows scalar number n in pixel n.
fn reader(declarations: &str, scalars: &[Scalar]) -> String {
    let cases: String = scalars
        .iter()
        .enumerate()
        .map(|(number, scalar)| format!("    case {number}: color = vec4(float({})); break;\n", scalar.path))
        .collect();
    format!(
        "{declarations}out vec4 color;\nvoid main() {{\n    \
         switch (int(gl_FragCoord.y) * {WIDTH} + int(gl_FragCoord.x)) {{\n{cases}    default: color = vec4(-1.0);\n    }}\n}}\n"
    )
}

/// The scene, and every scalar in the order of the pixels.
fn scene(declarations: &str) -> (Scene, Vec<Scalar>) {
    let program = fragment_program(&reader(declarations, &[]));
    let mut all = Vec::new();
    let mut uniforms = String::new();
    for leaf in &program.interface.uniforms {
        let own = scalars(&program.types, leaf, all.len());
        let is_float = program.types.scalar_of(leaf.ty) == Some(glisten_front::hir::Scalar::Float);
        let numbers: Vec<String> =
            own.iter().map(|one| if is_float { format!("{:?}", one.value) } else { one.value.to_string() }).collect();
        uniforms += &match numbers.as_slice() {
            [one] if leaf.array_size.is_none() => format!("\"{}\" = {one}\n", leaf.name),
            list => format!("\"{}\" = [{}]\n", leaf.name, list.join(", ")),
        };
        all.extend(own);
    }
    let height = all.len().div_ceil(WIDTH);
    let text = format!(
        "framebuffer = {{ width = {WIDTH}, height = {height} }}\n[[draw]]\nvertex = \"r.vert\"\nfragment = \"r.frag\"\n\
         primitive = \"triangles\"\nvertex_count = 3\n[draw.uniforms]\n{uniforms}"
    );
    let fragment = reader(declarations, &all);
    let files = MemoryFiles::new([("r.toml", text.as_str()), ("r.vert", VERTEX), ("r.frag", fragment.as_str())]);
    let loaded = scene::load("r.toml", &files, &compiler());
    let messages: Vec<_> = loaded.diagnostics.iter().map(|found| &found.message).collect();
    (loaded.scene.unwrap_or_else(|| panic!("{messages:?}\n{text}{fragment}")), all)
}

#[test]
fn every_scalar_comes_out_of_lavapipe_as_it_went_in() {
    let gpu = crate::drawing::gpu();
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let members = || proptest::collection::vec(member(), 1..8);
    for _ in 0..6 {
        let (loose, block) = (members(), members()).new_tree(&mut runner).expect("a tree").current();
        let (scene, scalars) = scene(&declarations(&loose, &block));
        assert!(scalars.len() > 4);
        let height = scene.framebuffer.height as usize;
        for via in [Via::Spirv, Via::Wgsl] {
            let picture = gpu.render(&scene, via).unwrap_or_else(|error| panic!("{error}")).picture;
            for (number, scalar) in scalars.iter().enumerate() {
                let row = height - 1 - number / WIDTH;
                let seen = picture.attachments[0][row * WIDTH + number % WIDTH][0];
                assert_eq!(seen, scalar.value, "{} via {}", scalar.path, via.name());
            }
        }
    }
}
