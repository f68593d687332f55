//! Assigns locations to vertex attributes (OpenGL 3.2 §2.11.3).
//!
//! `layout(location)` in the text takes precedence over a binding by name, and that over automatic assignment, which
//! takes the lowest free range of locations. Attributes that are read are assigned first, in order of declaration. A
//! matrix takes one location per column, an array one per element.

use super::{Attribute, Context};
use crate::builtin::constants::MAX_VERTEX_ATTRIBS;
use crate::diagnostic::{Diagnostic, codes};
use crate::hir::{ArraySize, Global, GlobalId, Shader, Storage, Type, TypeId, Types};

struct Candidate<'a> {
    id: GlobalId,
    global: &'a Global,
    columns: u32,
    location: Option<u32>,
}

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

/// Assigns locations to all inputs of the vertex stage. Attributes that nothing reads come last and are omitted if
/// they do not fit.
pub(super) fn assign(ctx: &mut Context<'_>, vertex: &Shader) -> Vec<Attribute> {
    let inputs = vertex
        .globals()
        .filter(|(_, global)| global.storage == Storage::In && global.builtin.is_none() && global.block.is_none());
    let mut candidates: Vec<Candidate<'_>> = inputs
        .map(|(id, global)| Candidate {
            id,
            global,
            columns: columns(ctx.types, global.ty),
            location: fixed_location(ctx, global),
        })
        .collect();
    let mut taken = Taken::default();
    for candidate in &candidates {
        if let Some(location) = candidate.location {
            place_fixed(ctx, vertex, &mut taken, candidate, location);
        }
    }
    for used in [true, false] {
        for candidate in candidates.iter_mut().filter(|candidate| candidate.global.used == used) {
            if candidate.location.is_none() {
                candidate.location = taken.find(candidate.columns);
                match candidate.location {
                    Some(location) => taken.mark(location, candidate.columns, candidate.id),
                    None if used => too_many(ctx, candidate),
                    None => {}
                }
            }
        }
    }
    candidates.into_iter().filter_map(attribute).collect()
}

fn attribute(candidate: Candidate<'_>) -> Option<Attribute> {
    Some(Attribute {
        name: candidate.global.name.clone(),
        ty: candidate.global.ty,
        global: candidate.id,
        location: candidate.location?,
        columns: candidate.columns,
        active: candidate.global.used,
    })
}

/// The attribute at each location.
#[derive(Default)]
struct Taken {
    by: [Option<GlobalId>; MAX_VERTEX_ATTRIBS as usize],
    /// How many attributes were found to share a location.
    n_shared: u32,
}

/// How many attributes that share a location are examined by a traversal of the shader.
const MAX_ALIASED: u32 = 64;

impl Taken {
    fn holder(&self, location: u32, columns: u32) -> Option<GlobalId> {
        self.by.get(location as usize..(location + columns) as usize)?.iter().find_map(|&holder| holder)
    }

    fn mark(&mut self, location: u32, columns: u32, id: GlobalId) {
        if let Some(slots) = self.by.get_mut(location as usize..(location + columns) as usize) {
            slots.fill(Some(id));
        }
    }

    fn find(&self, columns: u32) -> Option<u32> {
        let last = MAX_VERTEX_ATTRIBS.checked_sub(columns)?;
        (0..=last).find(|&location| self.holder(location, columns).is_none())
    }
}

/// The location that the text or a binding sets.
fn fixed_location(ctx: &mut Context<'_>, global: &Global) -> Option<u32> {
    let bound = ctx.bindings.attribute_locations.iter().rev().find(|(name, _)| *name == global.name);
    let bound = bound.map(|&(_, location)| location);
    if let (Some(declared), Some(bound)) = (global.location, bound)
        && declared != bound
    {
        let message =
            format!("`{}` is bound to location {bound}, and its declaration says {declared}, which wins", global.name);
        ctx.report(Diagnostic::new(&codes::link::BINDING_IGNORED, global.span, message));
    }
    global.location.or(bound)
}

fn place_fixed(ctx: &mut Context<'_>, vertex: &Shader, taken: &mut Taken, candidate: &Candidate<'_>, location: u32) {
    let Candidate { id, global, columns, .. } = *candidate;
    if location.checked_add(columns).is_none_or(|end| end > MAX_VERTEX_ATTRIBS) {
        let message = format!(
            "`{}` takes {} from location {location} on, and there are only {MAX_VERTEX_ATTRIBS}",
            global.name,
            plural(columns, "location")
        );
        ctx.report(Diagnostic::new(&codes::link::TOO_MANY_ATTRIBUTES, global.span, message));
        return;
    }
    let shared = (location..location + columns).find_map(|slot| Some((slot, taken.holder(slot, 1)?)));
    if let Some((slot, other)) = shared.filter(|_| taken.n_shared < MAX_ALIASED) {
        taken.n_shared += 1;
        aliased(ctx, vertex, (other, id), slot);
    }
    taken.mark(location, columns, id);
}

fn aliased(ctx: &mut Context<'_>, vertex: &Shader, (first, second): (GlobalId, GlobalId), location: u32) {
    let (other, global) = (vertex.global(first), vertex.global(second));
    let both = super::aliasing::path_reads_both(vertex, first, second);
    let code = if both { &codes::link::ATTRIBUTE_ALIASING } else { &codes::link::ATTRIBUTE_ALIASING_UNUSED };
    let message = format!("`{}` and `{}` share location {location}", other.name, global.name);
    let why = if both { "one run of the shader may read both" } else { "no run of the shader reads both" };
    ctx.report(Diagnostic::new(code, global.span, message).here(why).label(other.span, "the other one"));
}

fn too_many(ctx: &mut Context<'_>, candidate: &Candidate<'_>) {
    let message = format!(
        "no room for `{}`, which takes {} of the {MAX_VERTEX_ATTRIBS}",
        candidate.global.name,
        plural(candidate.columns, "location")
    );
    let help = "pack several scalars or short vectors into one `vec4`";
    ctx.report(Diagnostic::new(&codes::link::TOO_MANY_ATTRIBUTES, candidate.global.span, message).help(help));
}

/// `1 location`, `3 locations`
pub(super) fn plural(count: u32, noun: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{ending}")
}
