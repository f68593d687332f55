//! Which parts of a module's interface are not those of the emitted one.
//!
//! *In:* two interfaces. *Out:* a sentence for each difference. *Holds:* a module may leave out what it does not read: an
//! attribute, a varying of the fragment stage, a uniform, a texture. It may not leave out what others
//! read: an output, or a varying that the fragment stage reads.

use super::interface::{Interface, Resource, Slot, kind};
use glisten_front::hir::Stage;
use naga::ScalarKind;
use std::collections::BTreeMap;

/// The largest number of differences that are told.
const MOST: usize = 6;

/// The differences of an interface from the expected one.
pub(super) fn differences(found: &Interface, expected: &Interface, stage: Stage) -> Vec<String> {
    let (inputs, outputs) = match stage {
        Stage::Vertex => ("attribute", "varying"),
        _ => ("varying", "output"),
    };
    let is_vertex = stage == Stage::Vertex;
    let mut told = Vec::new();
    for (location, slot) in &found.inputs {
        // Attributes are not interpolated.
        told.extend(slot_difference(inputs, *location, slot, expected.inputs.get(location), !is_vertex));
    }
    for (location, slot) in &found.outputs {
        told.extend(slot_difference(outputs, *location, slot, expected.outputs.get(location), is_vertex));
    }
    for (location, slot) in expected.outputs.iter().filter(|(location, _)| !found.outputs.contains_key(location)) {
        told.push(format!("{outputs} at location {location}: there is none, the program writes {slot}"));
    }
    for (&(group, binding), resource) in &found.resources {
        let place = format!("group {group}, binding {binding}");
        match expected.resources.get(&(group, binding)) {
            None => told.push(format!("{place}: {resource}, where the program has nothing")),
            Some(wanted) => told.extend(resource_difference(&place, resource, wanted)),
        }
    }
    if told.len() > MOST {
        let more = told.len() - MOST;
        told.truncate(MOST);
        told.push(format!("and {more} more"));
    }
    told
}

fn slot_difference(what: &str, location: u32, found: &Slot, wanted: Option<&Slot>, is_varying: bool) -> Option<String> {
    let place = format!("{what} at location {location}");
    let Some(wanted) = wanted else {
        return Some(format!("{place}: {found}, where the program has nothing"));
    };
    let is_same = match is_varying {
        true => found == wanted,
        false => (found.scalar, found.components) == (wanted.scalar, wanted.components),
    };
    (!is_same).then(|| format!("{place}: {found}, the program has {wanted}"))
}

fn resource_difference(place: &str, found: &Resource, wanted: &Resource) -> Option<String> {
    match (found, wanted) {
        (Resource::Uniforms(found), Resource::Uniforms(wanted)) => block_difference(place, found, wanted),
        _ if found == wanted => None,
        _ => Some(format!("{place}: {found}, the program has {wanted}")),
    }
}

fn block_difference(
    place: &str,
    found: &BTreeMap<u32, ScalarKind>,
    wanted: &BTreeMap<u32, ScalarKind>,
) -> Option<String> {
    let (offset, scalar) = found.iter().find(|(offset, scalar)| wanted.get(offset) != Some(scalar))?;
    let has = wanted.get(offset).map_or("nothing", |scalar| kind(*scalar));
    Some(format!("{place}: its block has {} at offset {offset}, the program has {has}", kind(*scalar)))
}
