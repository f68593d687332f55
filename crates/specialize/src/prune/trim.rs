//! Members of structs that nobody names, and the ends of uniform arrays that nobody reaches.
//!
//! *In:* all stages of a program, rebuilt. *Out:* the same with smaller types; whether anything went.
//! *Holds:* structs between the stages, built-in ones and those that are compared as a whole stay. All stages have the same
//! type for the same name.

use glisten_front::hir::{
    ArraySize, BinaryOp, ConstructKind, ExprKind, GlobalId, ScalarValue, Shader, Storage, StructId, Type, TypeId,
    Types, Value, VarRef, is_pure,
};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;

/// Trims the types of a program. `open` says how many elements of an array open indices may reach.
pub(super) fn trim(types: &mut Types, stages: &mut [Shader], open: &BTreeMap<String, u32>) -> bool {
    let members = trim_members(types, stages);
    trim_arrays(types, stages, open) | members
}

fn trim_members(types: &mut Types, stages: &mut [Shader]) -> bool {
    let mut named: FxHashSet<(StructId, u32)> = FxHashSet::default();
    let mut fixed: FxHashSet<StructId> = FxHashSet::default();
    let mut seen: FxHashSet<StructId> = FxHashSet::default();
    for shader in stages.iter() {
        for global in &shader.globals {
            let between = matches!(global.storage, Storage::In | Storage::Out) || global.builtin.is_some();
            types.for_each_struct(global.ty, &mut |id| (if between { &mut fixed } else { &mut seen }).insert(id));
        }
        for local in shader.functions.iter().flat_map(|function| &function.locals) {
            types.for_each_struct(local.ty, &mut |id| seen.insert(id));
        }
        for expr in &shader.exprs {
            types.for_each_struct(expr.ty, &mut |id| seen.insert(id));
            match &expr.kind {
                ExprKind::Member(base, member) => {
                    if let Type::Struct(id) = types.get(shader.expr(*base).ty) {
                        named.insert((id, *member));
                    }
                }
                ExprKind::Binary(BinaryOp::Equal | BinaryOp::NotEqual, a, _) => {
                    types.for_each_struct(shader.expr(*a).ty, &mut |id| fixed.insert(id));
                }
                // What an argument does must be done.
                ExprKind::Construct(ConstructKind::Struct, arguments)
                    if arguments.iter().any(|argument| !is_pure(shader, *argument)) =>
                {
                    types.for_each_struct(expr.ty, &mut |id| fixed.insert(id));
                }
                _ => {}
            }
        }
    }
    let mut kept: BTreeMap<StructId, Vec<bool>> = BTreeMap::new();
    let mut candidates: Vec<StructId> = seen.into_iter().collect();
    candidates.sort_unstable();
    for id in candidates {
        let declared = types.structure(id);
        if fixed.contains(&id) || declared.name.starts_with("gl_") {
            continue;
        }
        let mut keep: Vec<bool> =
            (0..declared.members.len()).map(|member| named.contains(&(id, member as u32))).collect();
        if !keep.contains(&true)
            && let Some(first) = keep.first_mut()
        {
            *first = true;
        }
        if keep.contains(&false) {
            kept.insert(id, keep);
        }
    }
    if kept.is_empty() {
        return false;
    }
    apply(types, stages, &kept);
    true
}

fn apply(types: &mut Types, stages: &mut [Shader], kept: &BTreeMap<StructId, Vec<bool>>) {
    let before = types.clone();
    for shader in stages.iter_mut() {
        let tys: Vec<TypeId> = shader.exprs.iter().map(|expr| expr.ty).collect();
        for index in 0..shader.exprs.len() {
            let Some(expr) = shader.exprs.get_mut(index) else { continue };
            match &mut expr.kind {
                ExprKind::Member(base, member) => {
                    let base_ty = tys.get(base.index()).copied().unwrap_or(TypeId::ERROR);
                    if let Type::Struct(id) = before.get(base_ty)
                        && let Some(keep) = kept.get(&id)
                    {
                        *member = keep.iter().take(*member as usize).filter(|keep| **keep).count() as u32;
                    }
                }
                ExprKind::Construct(ConstructKind::Struct, arguments) => {
                    if let Type::Struct(id) = before.get(expr.ty)
                        && let Some(keep) = kept.get(&id)
                    {
                        let mut keep = keep.iter();
                        arguments.retain(|_| keep.next().copied().unwrap_or(true));
                    }
                }
                _ => {}
            }
        }
        for global in &mut shader.globals {
            if let Some(value) = &mut global.value {
                value.scalars = trimmed(&before, kept, value.ty, &mut value.scalars.iter().copied());
            }
        }
        for local in shader.functions.iter_mut().flat_map(|function| &mut function.locals) {
            if let Some(value) = &mut local.value {
                value.scalars = trimmed(&before, kept, value.ty, &mut value.scalars.iter().copied());
            }
        }
    }
    types.change_structures(|id, declaration| {
        if let Some(keep) = kept.get(&id) {
            let mut keep = keep.iter();
            declaration.members.retain(|_| keep.next().copied().unwrap_or(true));
        }
    });
}

/// The scalars of a value without those of members that go.
fn trimmed(
    types: &Types,
    kept: &BTreeMap<StructId, Vec<bool>>,
    ty: TypeId,
    scalars: &mut dyn Iterator<Item = ScalarValue>,
) -> Vec<ScalarValue> {
    match types.get(ty) {
        Type::Struct(id) => {
            let keep = kept.get(&id);
            let mut out = Vec::new();
            for (index, member) in types.structure(id).members.iter().enumerate() {
                let part = trimmed(types, kept, member.ty, scalars);
                if keep.is_none_or(|keep| keep.get(index).copied().unwrap_or(true)) {
                    out.extend(part);
                }
            }
            out
        }
        Type::Array(element, ArraySize::Sized(size)) => {
            (0..size).flat_map(|_| trimmed(types, kept, element, scalars)).collect()
        }
        _ => scalars.take(types.flat_len(ty) as usize).collect(),
    }
}

/// Arrays of loose uniforms end after the last element that is reached.
fn trim_arrays(types: &mut Types, stages: &mut [Shader], open: &BTreeMap<String, u32>) -> bool {
    let mut reach: FxHashMap<String, Option<u32>> = FxHashMap::default();
    for shader in stages.iter() {
        let mut indexed: FxHashSet<u32> = FxHashSet::default();
        for expr in &shader.exprs {
            let ExprKind::Index(base, index) = expr.kind else { continue };
            let ExprKind::Var(VarRef::Global(id)) = shader.expr(base).kind else { continue };
            indexed.insert(base.index() as u32);
            let known = match shader.expr(index).kind {
                ExprKind::Literal(ScalarValue::Int(value)) => u32::try_from(value).ok(),
                ExprKind::Literal(ScalarValue::Uint(value)) => Some(value),
                _ => None,
            };
            let reached = known.map(|index| index + 1).or_else(|| open.get(&shader.global(id).name).copied());
            note(&mut reach, shader, id, reached);
        }
        for (index, expr) in shader.exprs.iter().enumerate() {
            if let ExprKind::Var(VarRef::Global(id)) = expr.kind
                && !indexed.contains(&(index as u32))
            {
                note(&mut reach, shader, id, None);
            }
        }
    }
    let mut changed = false;
    for shader in stages.iter_mut() {
        for index in 0..shader.globals.len() {
            let Some(global) = shader.globals.get_mut(index) else { continue };
            let Type::Array(element, ArraySize::Sized(size)) = types.get(global.ty) else { continue };
            let Some(Some(last)) = reach.get(&global.name).copied() else { continue };
            if global.storage != Storage::Uniform || global.block.is_some() || last >= size {
                continue;
            }
            let ty = types.array(element, ArraySize::Sized(last));
            global.ty = ty;
            let len = types.flat_len(ty) as usize;
            global.value =
                global.value.take().map(|value| Value { ty, scalars: value.scalars.into_iter().take(len).collect() });
            global.initializer = None;
            changed = true;
            for expr in &mut shader.exprs {
                if matches!(expr.kind, ExprKind::Var(VarRef::Global(id)) if id == GlobalId::new(index)) {
                    expr.ty = ty;
                }
            }
        }
    }
    changed
}

fn note(reach: &mut FxHashMap<String, Option<u32>>, shader: &Shader, id: GlobalId, last: Option<u32>) {
    let name = &shader.global(id).name;
    match (reach.get_mut(name), last) {
        (Some(Some(known)), Some(last)) => *known = (*known).max(last),
        (Some(known), None) => *known = None,
        (Some(None), Some(_)) => {}
        (None, last) => {
            reach.insert(name.clone(), last);
        }
    }
}
