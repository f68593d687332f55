//! [`Numbers`]: locations and bindings of many programs at once, so that a declaration that several of them read has one number.
//!
//! *In:* for each program, what needs numbers, and the number that the link gave to it; which of them are one declaration. *Out:* a
//! number for each. *Holds:* within a program no two are alike in a space. Everything keeps the number of the link where it can.

use std::collections::BTreeMap;
use std::ops::Range;

/// The spaces in which numbers differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Space {
    Attribute,
    /// Between the vertex and the geometry stage.
    GeometryInput,
    Varying,
    Output,
    Buffer,
    Texture,
}

/// Something of a program that has a number.
#[derive(Clone, Debug)]
struct Node {
    unit: usize,
    space: Space,
    size: u32,
    wanted: Option<u32>,
    name: String,
}

/// The numbers of all programs.
#[derive(Default)]
pub(super) struct Numbers {
    nodes: Vec<Node>,
    index: BTreeMap<(usize, Space, String), usize>,
    /// For each node one that it is joined with; itself, if it is the first.
    parent: Vec<usize>,
    given: BTreeMap<usize, u32>,
}

impl Numbers {
    /// Something with a name, its number of places, and the number that it should have.
    pub(super) fn node(&mut self, unit: usize, space: Space, name: &str, size: u32, wanted: Option<u32>) -> usize {
        let next = self.nodes.len();
        let key = (unit, space, name.to_owned());
        let id = *self.index.entry(key).or_insert(next);
        if id == next {
            self.nodes.push(Node { unit, space, size: size.max(1), wanted, name: name.to_owned() });
            self.parent.push(id);
        }
        id
    }

    fn root(&self, mut id: usize) -> usize {
        while let Some(&parent) = self.parent.get(id)
            && parent != id
        {
            id = parent;
        }
        id
    }

    /// Says that two are one declaration.
    pub(super) fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        let (first, later) = (one.min(other), one.max(other));
        if let Some(parent) = self.parent.get_mut(later) {
            *parent = first;
        }
    }

    /// Gives the numbers.
    ///
    /// # Errors
    /// An output of a fragment stage, which cannot move, would need two numbers: the index of its program, and the reason.
    pub(super) fn solve(&mut self) -> Result<(), (usize, String)> {
        let mut classes: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for id in 0..self.nodes.len() {
            classes.entry(self.root(id)).or_default().push(id);
        }
        let units = |ids: &[usize]| {
            let mut units: Vec<usize> = ids.iter().filter_map(|id| Some(self.nodes.get(*id)?.unit)).collect();
            units.sort_unstable();
            units.dedup();
            units.len()
        };
        let mut order: Vec<(usize, Vec<usize>)> = classes.into_iter().collect();
        // What many programs share is placed first, and what wants no number last.
        let wants = |ids: &[usize]| ids.iter().any(|id| self.nodes.get(*id).is_some_and(|node| node.wanted.is_some()));
        order.sort_by_key(|(root, ids)| (!wants(ids), units(ids) < 2, *root));
        let mut taken: BTreeMap<(usize, Space), Vec<Range<u32>>> = BTreeMap::new();
        for (root, ids) in order {
            let members: Vec<&Node> = ids.iter().filter_map(|id| self.nodes.get(*id)).collect();
            let size = members.iter().map(|node| node.size).max().unwrap_or(1);
            let is_free = |number: &u32| {
                let range = *number..number.saturating_add(size);
                members.iter().all(|node| {
                    let others = taken.get(&(node.unit, node.space)).into_iter().flatten();
                    others.into_iter().all(|other| other.end <= range.start || range.end <= other.start)
                })
            };
            let wanted: Vec<u32> = members.iter().filter_map(|node| node.wanted).collect();
            let output = members.iter().find(|node| node.space == Space::Output);
            if let Some(node) = output.filter(|_| wanted.iter().any(|number| Some(number) != wanted.first())) {
                let what = "has different numbers in the programs that read its declaration";
                return Err((node.unit, format!("the output `{}` {what}", node.name)));
            }
            let number = wanted.iter().copied().find(is_free).or_else(|| (0..u32::MAX).find(is_free)).unwrap_or(0);
            for node in &members {
                taken.entry((node.unit, node.space)).or_default().push(number..number.saturating_add(size));
            }
            self.given.insert(root, number);
        }
        Ok(())
    }

    /// The number of a node.
    pub(super) fn of(&self, id: usize) -> u32 {
        self.given.get(&self.root(id)).copied().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::{Numbers, Space};

    #[test]
    fn one_declaration_has_one_number_in_all_programs() {
        let mut numbers = Numbers::default();
        // Program 0: `own` at 0, `shared` at 1. Program 1: `shared` at 0, `other` at 1 with two places.
        let own = numbers.node(0, Space::Varying, "own", 1, Some(0));
        let shared = numbers.node(0, Space::Varying, "shared", 1, Some(1));
        let again = numbers.node(1, Space::Varying, "shared", 1, Some(0));
        let other = numbers.node(1, Space::Varying, "other", 2, Some(1));
        let alone = numbers.node(1, Space::Texture, "map", 1, Some(1));
        numbers.join(shared, again);
        assert!(numbers.solve().is_ok());
        let all = [own, shared, again, other, alone].map(|id| numbers.of(id));
        assert_eq!(all, [0, 1, 1, 2, 1]);
    }

    #[test]
    fn outputs_do_not_move() {
        let mut numbers = Numbers::default();
        let one = numbers.node(0, Space::Output, "color", 1, Some(0));
        let other = numbers.node(1, Space::Output, "color", 1, Some(1));
        numbers.join(one, other);
        assert!(numbers.solve().is_err_and(|(_, reason)| reason.contains("`color`")));
    }
}
