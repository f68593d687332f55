//! Tests of foreign modules: what is read, and which interfaces fit.

use super::differs::differences;
use super::interface::Interface;
use super::read;
use crate::Via;
use glisten_emit::Emitted;
use glisten_front::hir::Stage;

fn interface(text: &str, stage: Stage) -> Interface {
    let module = read::parse(&Emitted::Text(text.to_owned())).expect("it is WGSL");
    Interface::of(&module, stage).expect("it has the stage")
}

const EMITTED: &str = "struct Block { a: vec3<f32>, b: f32, m: mat4x4<f32>, n: array<vec4<i32>, 3> }\n\
    @group(0) @binding(0) var<uniform> block: Block;\n\
    @group(1) @binding(0) var t: texture_2d<f32>;\n@group(1) @binding(1) var s: sampler;\n\
    struct Out { @location(0) c: vec4<f32> }\n\
    @fragment fn main(@location(0) x: vec2<f32>, @location(1) @interpolate(flat) i: i32) -> Out {\n\
    return Out(textureSample(t, s, x) + block.m[i & 3] + vec4(block.a, block.b)); }\n";

#[test]
fn a_module_may_wrap_its_data_otherwise_and_read_less() {
    let expected = interface(EMITTED, Stage::Fragment);
    assert_eq!(differences(&expected, &expected, Stage::Fragment), Vec::<String>::new());
    let other = "struct Block { a: vec4<f32>, m0: vec4<f32>, m1: vec4<f32>, m23: array<vec4<f32>, 2> }\n\
        @group(0) @binding(0) var<uniform> u: Block;\n\
        @fragment fn f(@location(0) x: vec2<f32>) -> @location(0) vec4<f32> { return u.m0 + u.a * x.x; }\n";
    assert_eq!(differences(&interface(other, Stage::Fragment), &expected, Stage::Fragment), Vec::<String>::new());
}

#[test]
fn each_part_that_differs_is_told() {
    let expected = interface(EMITTED, Stage::Fragment);
    let cases = [
        ("vec2<f32>", "vec3<f32>", "varying at location 0: vec3<f32>, the program has vec2<f32>"),
        ("@location(0) x", "@location(3) x", "varying at location 3: vec2<f32>, where the program has nothing"),
        (
            "@location(0) x",
            "@location(0) @interpolate(linear) x",
            "location 0: vec2<f32> noperspective, the program has vec2<f32>",
        ),
        ("@location(0) c", "@location(1) c", "output at location 0: there is none"),
        ("@location(0) c", "@location(1) c", "output at location 1: vec4<f32>, where the program has nothing"),
        ("a: vec3<f32>, b: f32", "b: f32, a: vec3<f32>", "group 0, binding 0: its block has f32 at offset"),
        ("array<vec4<i32>, 3>", "array<vec4<u32>, 3>", "its block has u32 at offset 80, the program has i32"),
        (
            "binding(0) var t",
            "binding(7) var t",
            "group 1, binding 7: a 2D texture of f32, where the program has nothing",
        ),
        (
            "texture_2d<f32>;",
            "texture_2d_array<f32>;",
            "a 2D array texture of f32, the program has a 2D texture of f32",
        ),
    ];
    for (from, to, part) in cases {
        let text = EMITTED.replace(from, to);
        let module = read::parse(&Emitted::Text(text)).or_else(|_| {
            // A change of a type changes how it is read.
            let text = EMITTED.replace(from, to).replace("textureSample(t, s, x)", "vec4<f32>()");
            read::parse(&Emitted::Text(text))
        });
        let found = Interface::of(&module.expect("it is WGSL"), Stage::Fragment).expect("it has the stage");
        let told = differences(&found, &expected, Stage::Fragment);
        assert!(told.iter().any(|one| one.contains(part)), "{part}: {told:?}");
    }
}

#[test]
fn what_is_no_module_is_refused() {
    let cases: [(&[u8], Via, &str); 7] = [
        (b"", Via::Wgsl, "empty"),
        (b"void main() {}", Via::Wgsl, "no valid WGSL"),
        (b"\xff\xfe", Via::Wgsl, "not UTF-8"),
        (b"fn f() {}\0", Via::Wgsl, "zero byte"),
        (b"fn f() {}", Via::Wgsl, "no entry point for the fragment stage"),
        (b"@fragment fn f() {}\n@fragment fn g() {}", Via::Wgsl, "2 entry points"),
        (b"garbage.", Via::Spirv, "no SPIR-V"),
    ];
    for (bytes, via, part) in cases {
        let told = read::read(bytes, Stage::Fragment, via).expect_err(part);
        assert!(told.contains(part), "{told}");
    }
    let huge = "@group(0) @binding(0) var<uniform> u: array<vec4<f32>, 100000000>;\n@fragment fn f() { _ = u[0]; }";
    let module = read::parse(&Emitted::Text(huge.to_owned())).expect("it is WGSL");
    assert!(Interface::of(&module, Stage::Fragment).is_err_and(|why| why.contains("bytes")));
}

#[test]
fn deep_nesting_is_an_error_and_no_crash() {
    for text in ["(".repeat(200_000), "{".repeat(200_000), "if true {".repeat(100_000)] {
        let text = format!("@fragment fn f() {{ {text}");
        assert!(read::parse(&Emitted::Text(text)).is_err());
    }
}

/// An instruction of SPIR-V.
fn instruction(opcode: u32, operands: &[u32]) -> Vec<u32> {
    let first = (operands.len() as u32 + 1) << 16 | opcode;
    std::iter::once(first).chain(operands.iter().copied()).collect()
}

/// A vertex stage that writes `layout(location = 2) out Data { mat2 m; float a[2]; vec3 b; }`, as glslang writes one: the
/// variable has the location.
fn with_block() -> Vec<u32> {
    let float = 1.0_f32.to_bits();
    let instructions: [&[u32]; 21] = [
        &[17, 1],                                        // OpCapability Shader
        &[14, 0, 1],                                     // OpMemoryModel Logical GLSL450
        &[15, 0, 1, u32::from_le_bytes(*b"main"), 0, 2], // OpEntryPoint Vertex %1 "main" %2
        &[71, 2, 30, 2],                                 // OpDecorate %2 Location 2
        &[71, 3, 2],                                     // OpDecorate %3 Block
        &[19, 4],                                        // OpTypeVoid
        &[33, 5, 4],                                     // OpTypeFunction
        &[22, 6, 32],                                    // OpTypeFloat
        &[23, 7, 6, 2],                                  // OpTypeVector
        &[24, 8, 7, 2],                                  // OpTypeMatrix
        &[21, 9, 32, 0],                                 // OpTypeInt
        &[43, 9, 10, 2],                                 // OpConstant
        &[28, 11, 6, 10],                                // OpTypeArray
        &[23, 12, 6, 3],                                 // OpTypeVector
        &[30, 3, 8, 11, 12],                             // OpTypeStruct
        &[32, 13, 3, 3],                                 // OpTypePointer Output
        &[59, 13, 2, 3],                                 // OpVariable Output
        &[43, 6, 14, float],                             // OpConstant
        &[54, 4, 1, 0, 5],                               // OpFunction
        &[248, 15],                                      // OpLabel
        &[253],                                          // OpReturn
    ];
    let body = instructions.iter().flat_map(|all| all.split_first().map(|(op, rest)| instruction(*op, rest)));
    let end = instruction(56, &[]);
    [0x0723_0203, 0x0001_0000, 0, 16, 0].into_iter().chain(body.flatten()).chain(end).collect()
}

#[test]
fn members_of_a_block_have_the_locations_after_that_of_its_variable() {
    let module = read::parse(&Emitted::Words(with_block())).expect("naga reads it");
    let interface = Interface::of(&module, Stage::Vertex).expect("it has the stage");
    let outputs: Vec<(u32, u8)> = interface.outputs.iter().map(|(at, slot)| (*at, slot.components)).collect();
    assert_eq!(outputs, [(2, 2), (3, 2), (4, 1), (5, 1), (6, 3)]);
}
