//! Assigns locations to vertex attributes (OpenGL 3.2 §2.11.3).
//!
//! *In:* the vertex stage. *Out:* its inputs with locations, assigned as [`declared`](super::declared) describes. A
//! matrix takes one location per column, an array one per element. Inputs may share locations if no path reads both,
//! but in ES from 3.00 on.

use super::declared::{Clash, Rules, Variable};
use super::{Attribute, Linker};
use crate::builtin::constants::MAX_VERTEX_ATTRIBS;
use crate::diagnostic::{Diagnostic, codes};
use crate::hir::{ArraySize, Shader, Storage, Type, TypeId, Types};
use crate::language::Feature;

/// The number of locations that an input of this type takes.
fn columns(types: &Types, ty: TypeId) -> u32 {
    match types.get(ty) {
        Type::Matrix(columns, _) => u32::from(columns),
        Type::Array(element, ArraySize::Sized(size)) => columns_of_element(types, element).saturating_mul(size),
        _ => 1,
    }
}

fn columns_of_element(types: &Types, ty: TypeId) -> u32 {
    match types.get(ty) {
        Type::Matrix(columns, _) => u32::from(columns),
        _ => 1,
    }
}

/// How many attributes that share a location are examined by a traversal of the shader.
const MAX_ALIASED: u32 = 64;

/// Assigns locations to all inputs of the vertex stage.
pub(super) fn assign(ctx: &mut Linker<'_>, vertex: &Shader) -> Vec<Attribute> {
    let rules = Rules {
        limit: MAX_VERTEX_ATTRIBS,
        rows: 1,
        words: ("location", "location"),
        too_many: &codes::link::TOO_MANY_ATTRIBUTES,
        help: Some("pack several scalars or short vectors into one `vec4`"),
        bindings: ctx.bindings.attribute_locations,
    };
    let inputs = vertex
        .globals()
        .filter(|(_, global)| global.storage == Storage::In && global.builtin.is_none() && global.block.is_none());
    let mut variables: Vec<Variable<'_>> = inputs
        .map(|(id, global)| Variable {
            id,
            global,
            count: columns(ctx.types, global.ty),
            row: 0,
            active: global.used,
            location: rules.fixed(ctx, global),
        })
        .collect();
    let mut n_shared = 0;
    rules.place(ctx, &mut variables, &mut |ctx, clash| {
        if n_shared < MAX_ALIASED {
            n_shared += 1;
            aliased(ctx, vertex, clash);
        }
    });
    variables.into_iter().filter_map(attribute).collect()
}

fn attribute(variable: Variable<'_>) -> Option<Attribute> {
    Some(Attribute {
        name: variable.global.name.clone(),
        ty: variable.global.ty,
        global: variable.id,
        location: variable.location?,
        columns: variable.count,
        active: variable.active,
    })
}

fn aliased(ctx: &mut Linker<'_>, vertex: &Shader, clash: &Clash) {
    let Clash { variables: (first, second), shared: location } = *clash;
    let (other, global) = (vertex.global(first), vertex.global(second));
    let both = super::aliasing::path_reads_both(vertex, first, second);
    let is_error = both || !vertex.version.has(Feature::AttributeAliasing);
    let code = if is_error { &codes::link::ATTRIBUTE_ALIASING } else { &codes::link::ATTRIBUTE_ALIASING_UNUSED };
    let message = format!("`{}` and `{}` share location {location}", other.name, global.name);
    let why = match (both, is_error) {
        (true, _) => "one run of the shader may read both",
        (false, false) => "no run of the shader reads both",
        (false, true) => "ES has no attributes that share one",
    };
    ctx.report(Diagnostic::new(code, global.span, message).here(why).label(other.span, "the other one"));
}
