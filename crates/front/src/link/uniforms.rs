//! Assigns offsets and bindings to uniforms and uniform blocks (GLSL 1.50 §4.3.5, §4.3.7; OpenGL 3.2 §2.11.4). All
//! stages share one name space.
//!
//! Loose uniforms are in one block at group 0, binding 0, with std140 layout in order of declaration; those that are
//! read come first. Uniform blocks follow; the elements of an array of blocks have consecutive bindings.
//! `gl_DepthRange` is a loose uniform with the default (0, 1, 1).

use super::compatible::{Free, MemberDifference, block_parts, compare_members, same_type, same_value, with_members};
use super::flatten::{join, parts};
use super::layout::{self, MAX_BLOCK_BYTES, array_stride, extent, round_up, struct_members};
use super::{Block, BlockIndex, Interface, Linker, RootIndex, SlotBinding, UniformLeaf, UniformRoot};
use crate::builtin::{BuiltinFunction, BuiltinVariable};
use crate::diagnostic::{Diagnostic, codes};
use crate::hir::{
    ArraySize, BlockLayout, ExprKind, Global, GlobalId, MatrixLayout, Member, SamplerDim, ScalarValue, Shader, Stage,
    Storage, Type, TypeId, Types, Value,
};
use crate::language::Feature;
use crate::source::Span;
use rustc_hash::FxHashMap;

const GROUP: u32 = 0;

/// A uniform or block, merged over all stages.
struct Shared<'a> {
    global: &'a Global,
    stage: Stage,
    globals: Vec<(Stage, GlobalId)>,
    default: Option<(&'a Value, &'a Global)>,
    /// The first declaration with an explicit location, which the others need not repeat.
    placed: Option<&'a Global>,
    active: bool,
    unit: Option<u32>,
}

impl Shared<'_> {
    fn is_block(&self) -> bool {
        self.global.block.is_some()
    }
}

/// Assigns offsets and bindings to all uniforms but samplers.
pub(super) fn assign(ctx: &mut Linker<'_>, stages: &[Shader], interface: &mut Interface) {
    super::precisions::check(ctx, stages);
    let mut all = unite(ctx, stages);
    check_host_locations(ctx, &all);
    check_names(ctx, &all, stages);
    all.sort_by_key(|shared| !shared.active);
    let types = ctx.types;
    let (blocks, loose): (Vec<_>, Vec<_>) = all.iter().partition(|shared| shared.is_block());
    let loose: Vec<_> = loose.into_iter().filter(|shared| !only_samplers(types, shared.global.ty)).collect();
    place_loose(ctx, &loose, stages, interface);
    place_blocks(ctx, &blocks, interface);
}

/// Checks that the declarations of a uniform or block agree in all shaders.
pub(super) fn check(ctx: &mut Linker<'_>, shaders: &[Shader]) {
    super::precisions::check(ctx, shaders);
    let all = unite(ctx, shaders);
    check_host_locations(ctx, &all);
    check_names(ctx, &all, shaders);
}

fn only_samplers(types: &Types, ty: TypeId) -> bool {
    match types.get(ty) {
        Type::Sampler(_) => true,
        Type::Array(element, _) => only_samplers(types, element),
        Type::Struct(id) => {
            let members = &types.structure(id).members;
            !members.is_empty() && members.iter().all(|member| only_samplers(types, member.ty))
        }
        Type::Error | Type::Void | Type::Scalar(_) | Type::Vector(..) | Type::Matrix(..) => false,
    }
}

/// Whether the fragment stage needs the framebuffer's height to flip `gl_FragCoord.y`.
fn reads_frag_coord(stages: &[Shader]) -> bool {
    stages.iter().filter(|shader| shader.stage == Stage::Fragment).any(|shader| {
        let reads = |global: &Global| global.used && global.builtin == Some(BuiltinVariable::FragCoord);
        !shader.frag_coord.origin_upper_left && shader.globals.iter().any(reads) && shader.reads_row_of_frag_coord()
    })
}

/// Whether a stage queries the size of a buffer texture.
fn asks_for_texels(types: &Types, stages: &[Shader]) -> bool {
    let is_buffer = |ty| matches!(types.get(ty), Type::Sampler(ty) if ty.dim == SamplerDim::Buffer);
    stages.iter().any(|shader| {
        shader.exprs.iter().any(|expr| match &expr.kind {
            ExprKind::BuiltinCall(BuiltinFunction::TextureSize, arguments) => {
                arguments.first().is_some_and(|sampler| is_buffer(shader.expr(*sampler).ty))
            }
            _ => false,
        })
    })
}

/// One entry per name, in order of first declaration.
fn unite<'a>(ctx: &mut Linker<'_>, stages: &'a [Shader]) -> Vec<Shared<'a>> {
    let mut all: Vec<Shared<'a>> = Vec::new();
    let mut indices: FxHashMap<(bool, &'a str), usize> = FxHashMap::default();
    for shader in stages {
        for (id, global) in shader.globals().filter(|(_, global)| is_shared(global)) {
            let name = global.match_name();
            let placed = global.host_location.map(|_| global);
            let index = *indices.entry((global.block.is_some(), name)).or_insert(all.len());
            match all.get_mut(index) {
                Some(known) => {
                    check_same(ctx, known, shader.stage, global);
                    known.globals.push((shader.stage, id));
                    known.active |= global.used;
                    known.unit = known.unit.or(global.unit());
                    known.default = known.default.or(global.value.as_ref().map(|value| (value, global)));
                    known.placed = known.placed.or(placed);
                }
                None => all.push(Shared {
                    global,
                    stage: shader.stage,
                    globals: vec![(shader.stage, id)],
                    default: global.value.as_ref().map(|value| (value, global)),
                    placed,
                    active: global.used,
                    unit: global.unit(),
                }),
            }
        }
    }
    all
}

/// Reports uniforms of one location, even if they are unused (GLSL 4.30 §4.4.3). A uniform takes a location for each of its scalars,
/// vectors, matrices and samplers.
fn check_host_locations(ctx: &mut Linker<'_>, all: &[Shared<'_>]) {
    let mut placed: Vec<(u64, u64, &Global)> = all
        .iter()
        .filter_map(|shared| {
            let global = shared.placed?;
            let first = u64::from(global.host_location?);
            Some((first, first.saturating_add(u64::from(ctx.types.leaves(global.ty))), global))
        })
        .collect();
    placed.sort_by_key(|(first, end, _)| (*first, *end));
    for pair in placed.windows(2) {
        let [(_, end, before), (first, _, after)] = pair else { continue };
        if first < end {
            let (one, other) = if before.span < after.span { (before, after) } else { (after, before) };
            let message = format!("the uniforms `{}` and `{}` both have location {first}", one.name, other.name);
            let diagnostic = Diagnostic::new(&codes::link::UNIFORM_OVERLAP, other.span, message)
                .label(one.span, "the other one")
                .help("give one of them another location; an array or a struct takes one for each element and member");
            ctx.report(diagnostic);
        }
    }
}

/// Reports a member of a block without an instance name that has the name of a uniform outside of it, from GLSL 4.40 and ES 3.10 on: "It
/// is a link-time error if any particular shader interface contains" both (4.40 §4.3.9).
fn check_names(ctx: &mut Linker<'_>, all: &[Shared<'_>], shaders: &[Shader]) {
    if ctx.bindings.stages_apart || !shaders.iter().all(|shader| shader.version.has(Feature::InterfaceNames)) {
        return;
    }
    let mut known: FxHashMap<&str, (Option<&str>, Span, Stage)> = FxHashMap::default();
    for shared in all {
        let members = exposed_members(ctx.types, shared.global);
        let is_loose = !shared.is_block();
        let own = is_loose.then_some((shared.global.name.as_str(), shared.global.span));
        let block = shared.global.block.as_ref().map(|block| block.name.as_str());
        for (name, span) in own.into_iter().chain(members.iter().map(|member| (member.name.as_str(), member.span))) {
            let (other, there, stage) = *known.entry(name).or_insert((block, span, shared.stage));
            // In one stage, the two are one name in one scope, which is reported there.
            if there == span || stage == shared.stage {
                continue;
            }
            let where_is = |block: Option<&str>, stage: Stage| match block {
                Some(block) => format!("a member of the block `{block}` in the {} stage", stage.name()),
                None => format!("a uniform outside of blocks in the {} stage", stage.name()),
            };
            let message = format!("`{name}` names two uniforms of the program");
            ctx.report(
                Diagnostic::new(&codes::link::UNIFORM_NAMES, span, message)
                    .here(where_is(block, shared.stage))
                    .label(there, where_is(other, stage))
                    .help("give one of them another name, or the block an instance name"),
            );
        }
    }
}

/// The members of a block whose names are those of its interface: of one without an instance name.
fn exposed_members<'a>(types: &'a Types, global: &Global) -> &'a [Member] {
    let is_exposed = global.block.as_ref().is_some_and(|block| block.instance.is_none());
    let parts = block_parts(types, global.ty).filter(|_| is_exposed);
    parts.map_or(&[], |(id, _)| types.structure(id).members.as_slice())
}

fn is_shared(global: &Global) -> bool {
    let builtin = match global.builtin {
        None => true,
        Some(BuiltinVariable::DepthRange) => global.used,
        Some(_) => false,
    };
    global.storage == Storage::Uniform && builtin
}

fn check_same(ctx: &mut Linker<'_>, known: &Shared<'_>, stage: Stage, global: &Global) {
    let types = ctx.types;
    if known.is_block() {
        check_same_block(ctx, known, stage, global);
        return;
    }
    if !same_type(types, known.global.ty, global.ty) {
        let message = format!("the uniform `{}` has another type in each stage", global.name);
        let diagnostic = Diagnostic::new(&codes::link::UNIFORM_TYPE_MISMATCH, global.span, message)
            .here(format!("`{}` in the {} stage", types.name(global.ty), stage.name()))
            .label(known.global.span, format!("`{}` in the {} stage", types.name(known.global.ty), known.stage.name()));
        ctx.report(with_members(diagnostic, types, (global.ty, stage), (known.global.ty, known.stage)));
        return;
    }
    if let (Some((value, declared)), Some(other)) = (known.default, global.value.as_ref())
        && !same_value(value, other)
    {
        let message = format!("the uniform `{}` has another initializer in each stage", global.name);
        let diagnostic = Diagnostic::new(&codes::link::UNIFORM_INITIALIZER_MISMATCH, global.span, message)
            .label(declared.span, "initialized here, too");
        ctx.report(diagnostic);
    }
    if let Some(other) = known.placed
        && let (Some(ours), Some(theirs)) = (global.host_location, other.host_location)
        && ours != theirs
    {
        // "any location specifiers of all declared uniform variables with the same name must match" (ES 3.10 §4.3.5; 4.60 §4.3.5).
        let message = format!("the uniform `{}` has another location in each stage", global.name);
        let diagnostic = Diagnostic::new(&codes::link::UNIFORM_TYPE_MISMATCH, global.span, message)
            .here(format!("location {ours} in the {} stage", stage.name()))
            .label(other.span, format!("location {theirs} in another"));
        ctx.report(diagnostic);
    }
    if let Some((ours, theirs)) = different_bindings(global, known.global) {
        let message = format!("the uniform `{}` has another binding in each stage", global.name);
        let diagnostic = Diagnostic::new(&codes::link::UNIFORM_TYPE_MISMATCH, global.span, message)
            .here(format!("{ours} in the {} stage", stage.name()))
            .label(known.global.span, format!("{theirs} in the {} stage", known.stage.name()));
        ctx.report(diagnostic);
    }
}

/// The two values of `layout(binding = n)`, if both are there and differ (ARB_shading_language_420pack).
fn different_bindings(a: &Global, b: &Global) -> Option<(String, String)> {
    let (ours, theirs) = (a.unit()?, b.unit()?);
    (ours != theirs).then(|| (format!("binding {ours}"), format!("binding {theirs}")))
}

fn check_same_block(ctx: &mut Linker<'_>, known: &Shared<'_>, stage: Stage, global: &Global) {
    let types = ctx.types;
    let (Some(ours), Some(theirs)) = (&global.block, &known.global.block) else { return };
    let (Some((our_members, our_size)), Some((their_members, their_size))) =
        (block_parts(types, global.ty), block_parts(types, known.global.ty))
    else {
        return;
    };
    let code = &codes::link::UNIFORM_BLOCK_MISMATCH;
    let name = &ours.name;
    let (our_stage, their_stage) = (stage.name(), known.stage.name());
    let whole = |what: &str, here: String, there: String| {
        Diagnostic::new(code, global.span, format!("the uniform block `{name}` {what}"))
            .here(format!("{here} in the {our_stage} stage"))
            .label(known.global.span, format!("{there} in the {their_stage} stage"))
    };
    let diagnostic = if our_size != their_size {
        whole("is another array in each stage", array_word(our_size), array_word(their_size))
    } else if ours.instance.is_some() != theirs.instance.is_some() {
        let word = |instance: &Option<String>| {
            instance.as_ref().map_or("no instance name".to_owned(), |name| format!("instance name `{name}`"))
        };
        whole("has an instance name in one stage alone", word(&ours.instance), word(&theirs.instance))
    } else if ours.layout != theirs.layout {
        let word = |layout: BlockLayout| format!("`{}`", layout_word(layout));
        whole("is laid out differently in each stage", word(ours.layout), word(theirs.layout))
    } else if let Some((here, there)) = different_bindings(global, known.global) {
        whole("has another binding in each stage", here, there)
    } else {
        match compare_members(types, our_members, their_members, Free::default()) {
            None => return,
            Some(MemberDifference::Count(ours, theirs)) => {
                whole("has another number of members in each stage", ours.to_string(), theirs.to_string())
            }
            Some(MemberDifference::Declaration(ours, theirs)) => {
                Diagnostic::new(code, ours.span, format!("the members of the uniform block `{name}` differ"))
                    .here(format!("`{} {}` in the {our_stage} stage", types.name(ours.ty), ours.name))
                    .label(
                        theirs.span,
                        format!("`{} {}` in the {their_stage} stage", types.name(theirs.ty), theirs.name),
                    )
            }
            Some(MemberDifference::Qualifiers(ours, theirs)) => {
                let message =
                    format!("`{}` of the uniform block `{name}` has another matrix order in each stage", ours.name);
                Diagnostic::new(code, ours.span, message)
                    .here(format!("`{}` in the {our_stage} stage", order_word(ours.matrix_layout)))
                    .label(theirs.span, format!("`{}` in the {their_stage} stage", order_word(theirs.matrix_layout)))
            }
        }
    };
    ctx.report(diagnostic);
}

fn array_word(size: Option<ArraySize>) -> String {
    match size {
        None => "no array".into(),
        Some(ArraySize::Sized(size)) => format!("{size} elements"),
        Some(ArraySize::Unsized) => "no size".into(),
    }
}

fn layout_word(layout: BlockLayout) -> &'static str {
    match layout {
        BlockLayout::Shared => "shared",
        BlockLayout::Packed => "packed",
        BlockLayout::Std140 => "std140",
    }
}

fn order_word(order: MatrixLayout) -> &'static str {
    match order {
        MatrixLayout::ColumnMajor => "column_major",
        MatrixLayout::RowMajor => "row_major",
    }
}

fn place_loose(ctx: &mut Linker<'_>, loose: &[&Shared<'_>], stages: &[Shader], interface: &mut Interface) {
    let types = ctx.types;
    let slot = SlotBinding { group: GROUP, binding: 0 };
    let mut end = 0;
    let order = MatrixLayout::ColumnMajor;
    for shared in loose {
        let room = extent(types, shared.global.ty, order);
        let offset = round_up(end, room.align);
        let new_end = offset.saturating_add(room.size);
        if new_end > MAX_BLOCK_BYTES {
            if shared.active {
                too_large(ctx, shared, new_end);
                return;
            }
            continue;
        }
        end = new_end;
        let root = RootIndex(interface.roots.len() as u32);
        interface.roots.push(UniformRoot {
            name: shared.global.name.clone(),
            ty: shared.global.ty,
            globals: shared.globals.clone(),
            block: None,
            offset,
            default: default_value(types, shared),
            active: shared.active,
        });
        let context = RootContext { root, slot, block_element: 0, flat_offset: 0, active: shared.active };
        leaves(types, &context, &shared.global.name, shared.global.ty, offset, order, &mut interface.uniforms);
    }
    end = round_up(end, 4);
    if reads_frag_coord(stages) {
        interface.framebuffer_height = Some(end);
        end += 4;
    }
    if asks_for_texels(types, stages) {
        let is_buffer = |ty| matches!(types.get(ty), Type::Sampler(ty) if ty.dim == SamplerDim::Buffer);
        for slot in interface.samplers.iter_mut().filter(|slot| slot.active && is_buffer(slot.ty)) {
            slot.texel_count = Some(end);
            end += 4;
        }
    }
    if end > 0 {
        interface.loose = Some((slot, round_up(end, 16)));
    }
}

fn default_value(types: &Types, shared: &Shared<'_>) -> Option<Value> {
    if shared.global.builtin == Some(BuiltinVariable::DepthRange) {
        let scalars = [0.0, 1.0, 1.0].map(ScalarValue::Float).to_vec();
        return Some(Value { ty: shared.global.ty, scalars });
    }
    let (value, _) = shared.default?;
    debug_assert_eq!(value.scalars.len(), types.flat_len(shared.global.ty) as usize);
    Some(Value { ty: shared.global.ty, scalars: value.scalars.clone() })
}

fn too_large(ctx: &mut Linker<'_>, shared: &Shared<'_>, bytes: u32) {
    let what = if shared.is_block() { "the uniform block" } else { "the loose uniforms up to" };
    let message = format!(
        "{what} `{}` take{} {bytes} bytes, and a uniform buffer has at most {MAX_BLOCK_BYTES}",
        shared.global.match_name(),
        if shared.is_block() { "s" } else { "" },
    );
    ctx.report(Diagnostic::new(&codes::link::TOO_MUCH_UNIFORM_STORAGE, shared.global.span, message));
}

/// The common properties of the leaves of one root.
struct RootContext {
    root: RootIndex,
    slot: SlotBinding,
    block_element: u32,
    flat_offset: u32,
    active: bool,
}

/// Adds the leaves of a value at a byte offset.
fn leaves(
    types: &Types,
    context: &RootContext,
    name: &str,
    ty: TypeId,
    offset: u32,
    order: MatrixLayout,
    list: &mut Vec<UniformLeaf>,
) {
    for part in parts(types, name, ty, order) {
        let (element, array_size) = match types.get(part.ty) {
            Type::Array(element, ArraySize::Sized(size)) => (element, Some(size)),
            _ => (part.ty, None),
        };
        if matches!(types.get(element), Type::Sampler(_) | Type::Error | Type::Array(..)) {
            continue;
        }
        let is_matrix = matches!(types.get(element), Type::Matrix(..));
        list.push(UniformLeaf {
            name: part.name,
            ty: element,
            array_size,
            root: context.root,
            block_element: context.block_element,
            flat_offset: context.flat_offset + part.flat_offset,
            slot: context.slot,
            offset: offset + layout::byte_offset(types, ty, part.flat_offset, order),
            array_stride: array_size.map(|_| array_stride(types, element, order)),
            matrix_stride: is_matrix.then(layout::matrix_stride),
            matrix_layout: if is_matrix { part.matrix_layout } else { MatrixLayout::ColumnMajor },
            active: context.active,
        });
    }
}

fn place_blocks(ctx: &mut Linker<'_>, blocks: &[&Shared<'_>], interface: &mut Interface) {
    let types = ctx.types;
    let mut binding = u32::from(interface.loose.is_some());
    for shared in blocks {
        let Some(block) = &shared.global.block else { continue };
        let Some((id, array)) = block_parts(types, shared.global.ty) else {
            let message = format!("the block `{}` is an array of arrays, which is not supported yet", block.name);
            ctx.report(Diagnostic::new(&codes::general::NOT_SUPPORTED_YET, shared.global.span, message));
            continue;
        };
        let array_size = match array {
            Some(ArraySize::Sized(size)) => Some(size),
            _ => None,
        };
        super::block_places::check(ctx, id);
        let members = struct_members(types, id, MatrixLayout::ColumnMajor);
        let size = round_up(members.last().map_or(0, |member| member.end), 16);
        let elements = array_size.unwrap_or(1);
        if size > MAX_BLOCK_BYTES {
            too_large(ctx, shared, size);
            continue;
        }
        if elements > MAX_BLOCKS {
            let message = format!(
                "the uniform block `{}` has {elements} elements, and a program at most {MAX_BLOCKS} blocks",
                block.name
            );
            ctx.report(Diagnostic::new(&codes::link::TOO_MANY_BLOCKS, shared.global.span, message));
            continue;
        }
        let root = RootIndex(interface.roots.len() as u32);
        let slot = SlotBinding { group: GROUP, binding };
        let element_len = types.structure(id).members.iter().map(|member| types.flat_len(member.ty)).sum::<u32>();
        for element in 0..elements {
            let slot = SlotBinding { group: GROUP, binding: binding + element };
            let prefix = match (&block.instance, array_size) {
                (None, _) => String::new(),
                (Some(_), None) => block.name.clone(),
                (Some(_), Some(_)) => format!("{}[{element}]", block.name),
            };
            let mut flat_offset = element * element_len;
            for (member, placed) in types.structure(id).members.iter().zip(&members) {
                let context = RootContext { root, slot, block_element: element, flat_offset, active: shared.active };
                let name = join(&prefix, &member.name);
                leaves(types, &context, &name, member.ty, placed.offset, placed.layout, &mut interface.uniforms);
                flat_offset += types.flat_len(member.ty);
            }
        }
        binding += elements;
        interface.roots.push(UniformRoot {
            name: block.name.clone(),
            ty: shared.global.ty,
            globals: shared.globals.clone(),
            block: Some(BlockIndex(interface.blocks.len() as u32)),
            offset: 0,
            default: None,
            active: shared.active,
        });
        interface.blocks.push(Block {
            name: block.name.clone(),
            instance: block.instance.clone(),
            array_size,
            slot,
            size,
            root,
            unit: shared.unit,
            active: shared.active,
        });
    }
}

/// More uniform buffers than any target binds in one stage.
const MAX_BLOCKS: u32 = 72;
