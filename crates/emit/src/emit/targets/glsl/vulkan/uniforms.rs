//! Loose uniforms as members of one block without an instance name, so that expressions name them as before.
//!
//! *Holds:* each member has its offset of the reflection in the text, so a stage may leave members out. It leaves out
//! those of other stages whose names mean something else in its own text; its block then has names of its own.

use super::opaque::{Apart, Path};
use super::{Layouts, declare, needs_height, own, plain, unused};
use crate::target::{Conventions, WindowOrigin};
use glisten_front::builtin::{BuiltinVariable, functions};
use glisten_front::hir::{
    BlockInfo, BlockLayout, Expr, ExprId, ExprKind, Global, GlobalId, Member, MemberPlace, ScalarValue, Shader,
    Storage, StructType, Type, TypeId, Types, VarRef, global_names,
};
use glisten_front::link::Program;
use glisten_front::source::Span;
use std::collections::BTreeMap;

/// The member that has the framebuffer's height.
#[derive(Clone, Copy)]
pub(super) struct Height {
    pub(super) block: GlobalId,
    pub(super) member: u32,
}

/// Moves the loose uniforms of a stage into a block. The result is the member with the framebuffer's height, if the
/// stage needs it.
pub(super) fn gather(
    types: &mut Types,
    shader: &mut Shader,
    program: &Program,
    conventions: &Conventions,
    layouts: &mut Layouts,
) -> Option<Height> {
    let reads_uniform = shader.globals.iter().any(|global| global.used && is_loose(types, global));
    let is_needed = reads_uniform || needs_height(shader, conventions);
    let mut apart = Apart::new(program);
    let mut found: Vec<(Member, Option<GlobalId>)> = Vec::new();
    let mut is_whole = true;
    let names = global_names(&program.types, shader, |_| false);
    for root in program.interface.roots.iter().filter(|root| root.block.is_none()) {
        let declared = own(&root.globals, shader.stage).next();
        let Some(ty) = apart.stripped(types, root.ty).filter(|_| root.name != BuiltinVariable::DepthRange.name())
        else {
            continue;
        };
        let hides = names.contains(&root.name) || !functions::named(&root.name).is_empty();
        if declared.is_none() && hides {
            is_whole = false;
            continue;
        }
        let span = declared.map_or(Span::default(), |global| shader.global(global).span);
        found.push((placed(&root.name, ty, root.offset, span), declared));
    }
    found.sort_by_key(|(member, _)| member.place.offset);
    let upper_left = conventions.window_origin == WindowOrigin::UpperLeft;
    let height = program.interface.framebuffer_height.filter(|_| upper_left).map(|offset| {
        let name = unused(program, "framebufferHeight");
        found.push((placed(&name, TypeId::FLOAT, offset, Span::default()), None));
        found.len() as u32 - 1
    });
    let numbered = found.iter().enumerate();
    let places = numbered.filter_map(|(place, (_, global))| Some(((*global)?, place as u32))).collect();
    let members: Vec<Member> = found.into_iter().map(|(member, _)| member).collect();
    let block =
        if members.is_empty() || !is_needed { None } else { block(types, shader, program, members, is_whole, layouts) };
    rewrite_uses(types, shader, &mut Moves { apart, places, block }, layouts);
    hide_declarations(types, shader);
    Some(Height { block: block?, member: height? })
}

/// A member at an offset.
fn placed(name: &str, ty: TypeId, offset: u32, span: Span) -> Member {
    let place = MemberPlace { offset: Some(offset), ..MemberPlace::default() };
    Member { place, ..Member::plain(name, ty, span) }
}

/// Where the loose uniforms went.
struct Moves<'a> {
    apart: Apart<'a>,
    /// The member of the block that a variable became.
    places: BTreeMap<GlobalId, u32>,
    block: Option<GlobalId>,
}

/// Declares the block. Blocks of one name must have the same members in all stages.
fn block(
    types: &mut Types,
    shader: &mut Shader,
    program: &Program,
    members: Vec<Member>,
    is_whole: bool,
    layouts: &mut Layouts,
) -> Option<GlobalId> {
    let (slot, _) = program.interface.loose?;
    let stage = shader.stage.name();
    let own_name = format!("{}{}Uniforms", stage.get(..1)?.to_uppercase(), stage.get(1..)?);
    let name = unused(program, if is_whole { "Uniforms" } else { &own_name });
    let structure = StructType { name: name.clone(), members, is_block: true, span: Span::default() };
    let ty = types.add_struct(structure);
    let binding = Some(slot.binding);
    // Two blocks without instance names cannot share the name of a member, even in two stages.
    let instance = (!is_whole).then(|| unused(program, "uniforms"));
    let info = BlockInfo { name: name.clone(), instance, layout: BlockLayout::Std140, binding };
    let id = declare(shader, Global { block: Some(info), ..plain(name, ty, Storage::Uniform) });
    layouts.set(id, slot);
    Some(id)
}

/// Lets expressions name members of the block, and samplers that were members of structs.
fn rewrite_uses(types: &mut Types, shader: &mut Shader, moves: &mut Moves<'_>, layouts: &mut Layouts) {
    let mut paths: BTreeMap<ExprId, Path> = BTreeMap::new();
    for id in shader.expr_ids() {
        let expr = shader.expr(id).clone();
        let Some(path) = path(types, shader, &paths, &expr) else { continue };
        let new = new_use(types, shader, moves, layouts, (&expr.kind, &path, &paths));
        if let (Some((kind, ty)), Some(expr)) = (new, shader.exprs.get_mut(id.index())) {
            (expr.kind, expr.ty) = (kind, ty);
        }
        paths.insert(id, path);
    }
}

/// The way from a loose uniform to the part that an expression names.
fn path(types: &Types, shader: &Shader, paths: &BTreeMap<ExprId, Path>, expr: &Expr) -> Option<Path> {
    match expr.kind {
        ExprKind::Var(VarRef::Global(global)) if is_loose(types, shader.global(global)) => {
            Some(Path { global, members: Vec::new(), indices: Vec::new(), ty: expr.ty })
        }
        ExprKind::Member(base, member) => {
            let mut path = paths.get(&base)?.clone();
            path.members.push(member);
            Some(Path { ty: expr.ty, ..path })
        }
        ExprKind::Index(base, at) => {
            let mut path = paths.get(&base)?.clone();
            path.indices.push(at);
            Some(Path { ty: expr.ty, ..path })
        }
        _ => None,
    }
}

/// The new expression at the end of a path, with its type.
fn new_use(
    types: &mut Types,
    shader: &mut Shader,
    moves: &mut Moves<'_>,
    layouts: &mut Layouts,
    (kind, path, paths): (&ExprKind, &Path, &BTreeMap<ExprId, Path>),
) -> Option<(ExprKind, TypeId)> {
    let Some(ty) = moves.apart.stripped(types, path.ty) else {
        return Some(if ends_in_sampler(types, path.ty) {
            (moves.apart.sampler(types, shader, path, layouts), path.ty)
        } else {
            // Nothing is left of the variable: what named its samplers names their own variables.
            (ExprKind::Literal(ScalarValue::Float(0.0)), TypeId::FLOAT)
        });
    };
    match kind {
        ExprKind::Var(_) => {
            let member = *moves.places.get(&path.global)?;
            Some((ExprKind::Member(super::variable(shader, moves.block?), member), ty))
        }
        ExprKind::Member(base, member) => {
            let of = paths.get(base)?.ty;
            Some((ExprKind::Member(*base, moves.apart.member(types, of, *member)), ty))
        }
        kind => Some((kind.clone(), ty)),
    }
}

/// Whether a type is a sampler or an array of samplers.
fn ends_in_sampler(types: &Types, ty: TypeId) -> bool {
    match types.get(ty) {
        Type::Sampler(_) => true,
        Type::Array(element, _) => ends_in_sampler(types, element),
        _ => false,
    }
}

/// Whether a variable is a loose uniform, and not a sampler or an array of samplers.
fn is_loose(types: &Types, global: &Global) -> bool {
    global.storage == Storage::Uniform
        && global.block.is_none()
        && global.builtin.is_none()
        && !ends_in_sampler(types, global.ty)
}

/// The old declarations are not printed.
fn hide_declarations(types: &Types, shader: &mut Shader) {
    for global in &mut shader.globals {
        let is_old = is_loose(types, global);
        if is_old {
            (global.storage, global.used, global.name) = (Storage::Private, false, String::new());
            (global.initializer, global.value) = (None, None);
        }
    }
}
