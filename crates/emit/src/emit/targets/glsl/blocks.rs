//! Blocks between stages as varyings of their own: GLSL ES 3.00 §4.3.7 has blocks of uniforms alone.
//!
//! *In:* a copy of a stage. *Out:* the same stage, in which `Block.member` is the varying `Block_member`. *Holds:* the
//! names depend on the program alone, so the stages agree.

use glisten_front::hir::{
    ExprKind, Global, GlobalId, Interpolation, Member, Shader, Stage, Storage, Type, Types, VarRef, fresh_name,
    global_names,
};
use glisten_front::link::{Program, Varying, VaryingEnd};
use std::collections::BTreeSet;

/// Replaces the blocks between the vertex and the fragment stage.
pub(super) fn flatten(types: &Types, shader: &mut Shader, program: &Program) {
    let between = match shader.stage {
        Stage::Vertex => Storage::Out,
        Stage::Geometry => return,
        Stage::Fragment => Storage::In,
    };
    let mut taken = None;
    for index in 0..shader.globals.len() {
        let Some(block) = shader.globals.get(index) else { continue };
        let Type::Struct(id) = types.get(block.ty) else { continue };
        if block.builtin.is_some() || block.block.is_none() || block.storage != between {
            continue;
        }
        let (block, first) = (block.clone(), shader.globals.len());
        let mut flat = 0;
        for member in &types.structure(id).members {
            let row = row_of(program, shader.stage, GlobalId::new(index), flat);
            let taken = taken.get_or_insert_with(|| names(program));
            let name = fresh_name(&format!("{}_{}", block.match_name(), member.name), |name| taken.contains(name));
            shader.globals.push(varying(name, &block, member, row));
            flat += types.flat_len(member.ty);
        }
        for at in 0..shader.exprs.len() {
            let Some(ExprKind::Member(base, number)) = shader.exprs.get(at).map(|expr| expr.kind.clone()) else {
                continue;
            };
            if matches!(shader.expr(base).kind, ExprKind::Var(VarRef::Global(id)) if id.index() == index)
                && let Some(expr) = shader.exprs.get_mut(at)
            {
                expr.kind = ExprKind::Var(VarRef::Global(GlobalId::new(first + number as usize)));
            }
        }
        if let Some(old) = shader.globals.get_mut(index) {
            // What nothing uses is not printed.
            (old.storage, old.used, old.block) = (Storage::Private, false, None);
        }
    }
}

/// The varying that a member is, if the stages agree on it.
fn row_of(program: &Program, stage: Stage, global: GlobalId, flat_offset: u32) -> Option<&Varying> {
    let own = Some(VaryingEnd { global, flat_offset });
    let mut rows = program.interface.varyings.iter();
    rows.find(|row| if stage == Stage::Vertex { row.from == own } else { row.to == own })
}

/// The names that are declared at the global scope of any stage.
fn names(program: &Program) -> BTreeSet<String> {
    program.stages.iter().flat_map(|shader| global_names(&program.types, shader, |_| false)).collect()
}

fn varying(name: String, block: &Global, member: &Member, row: Option<&Varying>) -> Global {
    let interpolation = row.map(|row| row.interpolation).or(member.interpolation).unwrap_or_default();
    Global {
        name,
        ty: member.ty,
        interpolation,
        interpolation_written: interpolation != Interpolation::Smooth,
        sampling: row.map_or(member.sampling, |row| row.sampling),
        invariant: block.invariant || member.invariant,
        block: None,
        used: true,
        span: member.span,
        ..block.clone()
    }
}
