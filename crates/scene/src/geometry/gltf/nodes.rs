//! The nodes of a glTF file's scene.
//!
//! *In:* the document. *Out:* the nodes in the order of a walk from the roots, and the matrix of each to world space. *Holds:* each node
//! is visited once; one that is reached twice keeps its first place.

use glam::{DMat4, DQuat, DVec3, Mat4};
use gltf::json::Root;
use gltf::json::scene::Node;
use std::collections::BTreeSet;

/// The nodes of a scene.
pub(super) struct Nodes {
    /// Their numbers.
    pub(super) order: Vec<usize>,
    /// How often the walk came to a node again: the nodes of a file are trees (§3.5.2).
    n_again: usize,
    worlds: Vec<DMat4>,
}

impl Nodes {
    /// The nodes of the default scene, or of the first one; without scenes, all.
    pub(super) fn of(root: &Root) -> Result<Self, String> {
        let scene = root.scene.map_or(0, |scene| scene.value());
        let children = root.nodes.iter().flat_map(|node| node.children.iter().flatten());
        let children: BTreeSet<usize> = children.map(|child| child.value()).collect();
        let starts: Vec<usize> = match root.scenes.get(scene) {
            Some(scene) => scene.nodes.iter().map(|node| node.value()).collect(),
            None if !root.scenes.is_empty() => return Err(format!("there is no scene {scene}")),
            None => (0..root.nodes.len()).filter(|node| !children.contains(node)).collect(),
        };
        let mut nodes = Self { order: Vec::new(), n_again: 0, worlds: vec![DMat4::IDENTITY; root.nodes.len()] };
        let mut visited = vec![false; root.nodes.len()];
        let mut stack: Vec<(usize, DMat4)> = starts.into_iter().rev().map(|node| (node, DMat4::IDENTITY)).collect();
        while let Some((number, parent)) = stack.pop() {
            let node = root.nodes.get(number).ok_or_else(|| format!("there is no node {number}"))?;
            match visited.get_mut(number) {
                Some(seen) if !*seen => *seen = true,
                _ => {
                    nodes.n_again += 1;
                    continue;
                }
            }
            let world = parent * local(node);
            if !world.is_finite() {
                return Err(format!("node {number}: its transform is not finite"));
            }
            if let Some(slot) = nodes.worlds.get_mut(number) {
                *slot = world;
            }
            nodes.order.push(number);
            stack.extend(node.children.iter().flatten().rev().map(|child| (child.value(), world)));
        }
        Ok(nodes)
    }

    /// A sentence on nodes that more than one node has as its child, or that are below themselves.
    pub(super) fn remark(&self) -> Option<String> {
        let times = if self.n_again == 1 { "once".to_owned() } else { format!("{} times", self.n_again) };
        (self.n_again > 0).then(|| format!("its nodes are no trees: {times}, a node is reached again, and is left out"))
    }

    /// The matrix of a node to world space.
    pub(super) fn world(&self, node: usize) -> DMat4 {
        self.worlds.get(node).copied().unwrap_or(DMat4::IDENTITY)
    }
}

/// The matrix of a node to its parent's space (§3.5.2).
fn local(node: &Node) -> DMat4 {
    if let Some(matrix) = &node.matrix {
        return Mat4::from_cols_array(matrix).as_dmat4();
    }
    let vector = |given: Option<[f32; 3]>, otherwise: f64| {
        given.map_or(DVec3::splat(otherwise), |given| DVec3::from(given.map(f64::from)))
    };
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |rotation| {
        let rotation = DQuat::from_array(rotation.0.map(f64::from));
        if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY }
    });
    DMat4::from_scale_rotation_translation(vector(node.scale, 1.0), rotation, vector(node.translation, 0.0))
}
