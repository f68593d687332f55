//! Reports attributes without data, with what to paste.
//!
//! *In:* the attributes that the scene gives no data. *Out:* one diagnostic for those that can reach an output, one for the others.
//! *Holds:* the help is one list, and the scene loads after it was pasted.

use super::mesh::{Mesh, likely_roles};
use super::paste::{self, Lines, key};
use crate::roles::AttributeRole;
use crate::tables::Reader;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::{SCENE_MISSING_ATTRIBUTE, SCENE_UNSET_ATTRIBUTE};
use glisten_front::hir::{Scalar, Type};
use glisten_front::link::{Attribute, Program};
use glisten_front::source::Span;
use toml::de::DeTable;

/// The attributes without data of a draw, and what else it has.
pub(super) struct Missing<'a> {
    pub(super) program: &'a Program,
    /// Those without data.
    pub(super) attributes: Vec<&'a Attribute>,
    pub(super) mesh: Option<&'a Mesh>,
    /// The roles that the mesh has handed out.
    pub(super) handed_out: Vec<AttributeRole>,
    /// The number of vertices that other attributes have data for.
    pub(super) rows: Option<u32>,
    pub(super) instances: u32,
    pub(super) span: Span,
}

impl Missing<'_> {
    /// Reports an error for those that can reach the position or an output, a warning for the others, which are (0, 0, 0, 1).
    pub(super) fn report(&self, reader: &mut Reader, draw: &DeTable<'_>, reaching: &[&str]) {
        let reaches = |attribute: &&&Attribute| reaching.contains(&attribute.name.as_str());
        let (needed, idle): (Vec<&Attribute>, Vec<&Attribute>) =
            self.attributes.iter().partition(|attribute| reaches(attribute));
        if !needed.is_empty() {
            let (names, have, them) = told(&needed);
            let lacks = self.lacks(&needed);
            let message = format!("{names} {have} no data: the vertex shader reads {them}{lacks}");
            let diagnostic = Diagnostic::new(&SCENE_MISSING_ATTRIBUTE, self.span, message);
            self.finish(reader, draw, &needed, diagnostic);
        }
        if !idle.is_empty() {
            let (names, have, them) = told(&idle);
            let are = if idle.len() == 1 { "is" } else { "are" };
            let message =
                format!("{names} {have} no data and {are} (0, 0, 0, 1): nothing that is drawn depends on {them}");
            let diagnostic = Diagnostic::new(&SCENE_UNSET_ATTRIBUTE, self.span, message);
            self.finish(reader, draw, &idle, diagnostic);
        }
    }

    fn finish(&self, reader: &mut Reader, draw: &DeTable<'_>, list: &[&Attribute], mut diagnostic: Diagnostic) {
        for attribute in list.iter().take(8) {
            diagnostic = diagnostic.label(global_span(self.program, attribute), "declared here");
        }
        let help = self.help(reader, draw, list);
        reader.report_missing(diagnostic.maybe_help(help));
    }

    /// The end of the message: the mesh has no colors, if an attribute is named after them.
    fn lacks(&self, needed: &[&Attribute]) -> String {
        let Some(mesh) = self.mesh.filter(|mesh| !mesh.has(AttributeRole::Color)) else { return String::new() };
        let roles = likely_roles(&[AttributeRole::Color], self.program, needed);
        if roles.iter().all(Option::is_none) {
            return String::new();
        }
        format!(", and {} has no colors", mesh.source())
    }

    fn help(&self, reader: &Reader, draw: &DeTable<'_>, list: &[&Attribute]) -> Option<String> {
        let roles = match self.mesh {
            Some(mesh) => mesh.likely(self.program, &self.handed_out, list),
            None => {
                if let Some(shape) = self.shape(draw, list) {
                    return Some(shape);
                }
                vec![None; list.len()]
            }
        };
        let pairs = list.iter().zip(&roles);
        let lines = pairs.clone().filter_map(|(attribute, role)| Some(assignment((*role)?, attribute)));
        let mesh = Lines::new("mesh", lines.collect());
        let rest = pairs.filter(|(_, role)| role.is_none()).map(|(attribute, _)| self.data(draw, attribute));
        paste::help(reader, draw, &[mesh, Lines::new("attributes", rest.collect())])
    }

    /// A mesh that feeds all attributes, if nothing else says what is drawn.
    fn shape(&self, draw: &DeTable<'_>, list: &[&Attribute]) -> Option<String> {
        let given =
            ["attributes", "indices", "vertex_count", "primitive", "mesh"].iter().any(|key| draw.contains_key(*key));
        if given || list.len() < self.attributes.len() {
            return None;
        }
        // A shape has neither.
        let lacks = |role: &AttributeRole| matches!(role, AttributeRole::Color | AttributeRole::Texcoord2);
        let free: Vec<AttributeRole> = AttributeRole::ALL.into_iter().filter(|role| !lacks(role)).collect();
        let roles: Option<Vec<AttributeRole>> = likely_roles(&free, self.program, list).into_iter().collect();
        let assignments: Vec<String> =
            list.iter().zip(roles?).map(|(attribute, role)| assignment(role, attribute)).collect();
        Some(format!("add `mesh = {{ shape = \"sphere\", {} }}` to the draw", assignments.join(", ")))
    }

    /// Data for one attribute: a triangle if nothing says how many vertices there are, otherwise one row for all.
    fn data(&self, draw: &DeTable<'_>, attribute: &Attribute) -> String {
        let types = &self.program.types;
        let size = types.flat_len(attribute.ty).max(1) as usize;
        let role = crate::roles::likely_attribute_role(&attribute.name, types.get(attribute.ty));
        let integers = super::attributes::scalar_of(types, attribute.ty) != Scalar::Float;
        let text = |values: &[f32]| {
            let number = |value: &f32| if integers { format!("{}", *value as i32) } else { format!("{value:?}") };
            values.iter().map(number).collect::<Vec<_>>().join(", ")
        };
        let constant = constant(role, types.get(attribute.ty), size);
        let has_rows = self.mesh.is_some() || self.rows.is_some() || draw.contains_key("vertex_count");
        let name = key(&attribute.name);
        if has_rows {
            let divisor = self.instances.max(1);
            return format!("{name} = {{ size = {size}, divisor = {divisor}, values = [{}] }}", text(&constant));
        }
        let row = |corner: [f32; 4]| -> Vec<f32> {
            match role {
                Some(AttributeRole::Position) | None if size <= 4 && !integers => {
                    corner.iter().copied().take(size).collect()
                }
                _ => constant.clone(),
            }
        };
        let rows =
            [[-1.0, -1.0, 0.0, 1.0], [1.0, -1.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]].map(|corner| text(&row(corner)));
        format!("{name} = {{ size = {size}, values = [{}] }}", rows.join(",  "))
    }
}

/// The names, `has` or `have`, `it` or `them`.
fn told(list: &[&Attribute]) -> (String, &'static str, &'static str) {
    let names: Vec<&str> = list.iter().map(|attribute| attribute.name.as_str()).collect();
    match list.len() {
        1 => (format!("attribute {}", paste::names(&names)), "has", "it"),
        _ => (format!("attributes {}", paste::names(&names)), "have", "them"),
    }
}

fn assignment(role: AttributeRole, attribute: &Attribute) -> String {
    format!("{} = \"{}\"", role.name(), attribute.name)
}

/// A value that does no harm.
fn constant(role: Option<AttributeRole>, ty: Type, size: usize) -> Vec<f32> {
    if let Type::Matrix(_, rows) = ty {
        let rows = usize::from(rows);
        return (0..size).map(|index| if index / rows == index % rows { 1.0 } else { 0.0 }).collect();
    }
    let row = match role {
        Some(AttributeRole::Color) => [1.0; 4],
        Some(AttributeRole::Normal) => [0.0, 0.0, 1.0, 0.0],
        Some(AttributeRole::Tangent) => [1.0, 0.0, 0.0, 1.0],
        Some(AttributeRole::Bitangent) => [0.0, 1.0, 0.0, 0.0],
        _ => [0.0, 0.0, 0.0, 1.0],
    };
    (0..size).map(|index| row.get(index).copied().unwrap_or(0.0)).collect()
}

/// The place of an attribute's declaration.
pub(super) fn global_span(program: &Program, attribute: &Attribute) -> Span {
    let shader = program.stages.first();
    let global = shader.and_then(|shader| shader.globals.get(attribute.global.index()));
    global.map_or_else(Span::default, |global| global.span)
}
