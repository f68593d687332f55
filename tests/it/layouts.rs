//! Layouts checked against the emitted code: for random sets of uniforms, the offsets and strides in the interface
//! (which the reflection shows) are the natural ones of the emitted WGSL, and those of the SPIR-V's decorations.

use crate::support::fragment_program;
use glisten_emit::{Conventions, Emitted, Target, emit};
use glisten_front::hir::Stage;
use glisten_front::link::{Program, SlotBinding, UniformLeaf};
use naga::{Handle, Module, Type, TypeInner};
use proptest::prelude::*;

/// Types that a member may have.
const TYPES: [&str; 24] = [
    "float", "int", "uint", "bool", "vec2", "vec3", "vec4", "ivec2", "ivec3", "uvec4", "bvec2", "bvec3", "mat2",
    "mat3", "mat4", "mat2x3", "mat2x4", "mat3x2", "mat3x4", "mat4x2", "mat4x3", "Small", "Large", "Nested",
];

/// Structs with the usual traps: smaller than 16 bytes, a vec3 before a scalar, arrays of short elements inside.
const STRUCTS: &str = "struct Small { float value; };\n\
    struct Large { vec3 direction; float power; vec2 cone[2]; bool on; mat3x2 frame; };\n\
    struct Nested { bool first; Small small; Large larges[2]; int last; };\n";

#[derive(Clone, Debug)]
pub(crate) struct Member {
    ty: &'static str,
    len: Option<u32>,
    row_major: bool,
}

pub(crate) fn member() -> impl Strategy<Value = Member> {
    (0..TYPES.len(), proptest::option::of(1_u32..4), any::<bool>()).prop_map(|(ty, len, row_major)| Member {
        ty: TYPES[ty],
        len,
        row_major,
    })
}

/// `a`, `b`, ...: names without digits, which no writer changes.
fn name(prefix: &str, index: usize) -> String {
    format!("{prefix}_{}", (b'a' + index as u8) as char)
}

fn declaration(member: &Member, name: &str) -> String {
    let array = member.len.map_or_else(String::new, |len| format!("[{len}]"));
    format!("{} {name}{array};\n", member.ty)
}

/// An expression that reads something of the member, so that the member is in use.
fn reading(member: &Member, path: &str) -> String {
    let path = if member.len.is_some() { format!("{path}[0]") } else { path.to_owned() };
    match member.ty {
        "Small" => format!("float({path}.value)"),
        "Large" => format!("float({path}.power)"),
        "Nested" => format!("float({path}.last)"),
        ty if ty.starts_with("mat") => format!("float({path}[0].x)"),
        ty if ty.contains("vec") => format!("float({path}.x)"),
        _ => format!("float({path})"),
    }
}

/// The version, loose uniforms, and a block of further members.
pub(crate) fn declarations(loose: &[Member], block: &[Member]) -> String {
    let mut text = format!("#version 150\n{STRUCTS}");
    for (index, member) in loose.iter().enumerate() {
        text.push_str(&format!("uniform {}", declaration(member, &name("loose", index))));
    }
    text.push_str("layout(std140) uniform Block {\n");
    for (index, member) in block.iter().enumerate() {
        let order = if member.row_major { "layout(row_major) " } else { "" };
        text.push_str(&format!("{order}{}", declaration(member, &name("member", index))));
    }
    text + "} block;\n"
}

fn source(loose: &[Member], block: &[Member]) -> String {
    let loose_reads = loose.iter().enumerate().map(|(index, member)| reading(member, &name("loose", index)));
    let block_reads =
        block.iter().enumerate().map(|(index, member)| reading(member, &format!("block.{}", name("member", index))));
    let reads: Vec<String> = std::iter::once("0.0".to_owned()).chain(loose_reads).chain(block_reads).collect();
    let declarations = declarations(loose, block);
    format!("{declarations}out vec4 color;\nvoid main() {{ color = vec4({}); }}\n", reads.join(" + "))
}

fn emitted(program: &Program, target: Target) -> Emitted {
    emit(program, Stage::Fragment, target, &Conventions::default()).expect("a valid program is emitted")
}

fn variable(module: &Module, slot: SlotBinding) -> Handle<Type> {
    let at = |variable: &naga::GlobalVariable| {
        variable.binding.is_some_and(|own| own.group == slot.group && own.binding == slot.binding)
    };
    let (_, variable) =
        module.global_variables.iter().find(|(_, variable)| at(variable)).expect("a variable at the slot");
    variable.ty
}

/// A step of a path: a member by name, or an element.
enum Step<'a> {
    Member(&'a str),
    Element(u32),
}

fn steps(path: &str) -> Vec<Step<'_>> {
    let mut steps = Vec::new();
    for part in path.split('.') {
        let (name, rest) = part.split_once('[').map_or((part, None), |(name, rest)| (name, Some(rest)));
        steps.push(Step::Member(name));
        if let Some(index) = rest {
            let index = index.trim_end_matches(']').parse().expect("an index");
            steps.push(Step::Element(index));
        }
    }
    steps
}

/// Where a path leads in the WGSL module and in the SPIR-V module. Both are followed together, because SPIR-V has no
/// names.
fn walk(modules: [&Module; 2], slot: SlotBinding, path: &[Step<'_>]) -> [(u32, Handle<Type>); 2] {
    let mut at = modules.map(|module| (0, variable(module, slot)));
    // naga's SPIR-V wraps every block in a struct of its own, at offset 0.
    if let TypeInner::Struct { members, .. } = &modules[1].types[at[1].1].inner {
        assert_eq!((members.len(), members[0].offset), (1, 0), "the struct around the block");
        at[1].1 = members[0].ty;
    }
    for step in path {
        let number = match step {
            Step::Element(index) => *index as usize,
            Step::Member(name) => match &modules[0].types[at[0].1].inner {
                TypeInner::Struct { members, .. } => {
                    let named = |member: &naga::StructMember| member.name.as_deref() == Some(*name);
                    members.iter().position(named).unwrap_or_else(|| panic!("no member `{name}` in {members:?}"))
                }
                other => panic!("`{name}` in {other:?}"),
            },
        };
        for (module, (offset, ty)) in modules.iter().zip(&mut at) {
            match &module.types[*ty].inner {
                TypeInner::Struct { members, .. } => {
                    *offset += members[number].offset;
                    *ty = members[number].ty;
                }
                TypeInner::Array { base, stride, .. } => {
                    *offset += stride * number as u32;
                    *ty = *base;
                }
                other => panic!("a step into {other:?}"),
            }
        }
    }
    at
}

fn check(program: &Program, leaf: &UniformLeaf, modules: [&Module; 2]) {
    let path = leaf.name.strip_prefix("Block.").unwrap_or(&leaf.name);
    for (module, (offset, ty)) in modules.iter().zip(walk(modules, leaf.slot, &steps(path))) {
        assert_eq!(offset, leaf.offset, "the offset of {}", leaf.name);
        let mut inner = &module.types[ty].inner;
        if let Some(expected) = leaf.array_stride {
            let TypeInner::Array { base, stride, .. } = inner else { panic!("{} is an array", leaf.name) };
            assert_eq!(*stride, expected, "the array stride of {}", leaf.name);
            inner = &module.types[*base].inner;
        }
        if let Some(expected) = leaf.matrix_stride {
            let stride = match inner {
                TypeInner::Matrix { rows, .. } => {
                    if *rows == naga::VectorSize::Bi {
                        8
                    } else {
                        16
                    }
                }
                TypeInner::Array { stride, .. } => *stride,
                other => panic!("{} is a matrix, not {other:?}", leaf.name),
            };
            assert_eq!(stride, expected, "the matrix stride of {} ({})", leaf.name, program.types.name(leaf.ty));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_interface_wgsl_and_spirv_agree_on_every_offset(
        loose in proptest::collection::vec(member(), 1..8),
        block in proptest::collection::vec(member(), 1..8),
    ) {
        let text = source(&loose, &block);
        let program = fragment_program(&text);
        let Emitted::Text(wgsl) = emitted(&program, Target::Wgsl) else { panic!("WGSL is text") };
        let Emitted::Words(words) = emitted(&program, Target::Spirv) else { panic!("SPIR-V is words") };
        let from_wgsl = naga::front::wgsl::parse_str(&wgsl).expect("the text is WGSL");
        let bytes: Vec<u8> = words.into_iter().flat_map(u32::to_le_bytes).collect();
        let options = naga::front::spv::Options::default();
        let from_spirv = naga::front::spv::parse_u8_slice(&bytes, &options).expect("the words are SPIR-V");
        prop_assert!(program.interface.uniforms.len() >= loose.len() + block.len());
        for leaf in &program.interface.uniforms {
            check(&program, leaf, [&from_wgsl, &from_spirv]);
        }
    }
}
