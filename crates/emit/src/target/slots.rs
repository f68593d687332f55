//! [`Slots`]: the numbers of buffers, textures and samplers in targets that number each kind by itself: Metal's
//! `[[buffer(n)]]`, `[[texture(n)]]`, `[[sampler(n)]]`, and Direct3D's registers `b`, `t` and `s`.
//!
//! *In:* an [`Interface`]. *Out:* a number for each binding. *Holds:* the numbers are dense from 0 and the same in
//! both stages and in both targets.

use super::Target;
use glisten_front::link::{Interface, SlotBinding};
use std::collections::BTreeMap;

/// The kinds of resources.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum SlotKind {
    Buffer,
    Texture,
    Sampler,
}

/// The number of each binding.
#[derive(Clone, Debug, Default)]
pub(crate) struct Slots(BTreeMap<SlotBinding, (SlotKind, u32)>);

impl Slots {
    /// The numbers of a program's resources.
    pub(crate) fn of(interface: &Interface) -> Self {
        let mut slots = Self::default();
        let blocks = interface.blocks.iter().flat_map(|block| {
            let first = block.slot;
            (0..block.array_size.unwrap_or(1))
                .map(move |index| SlotBinding { binding: first.binding.saturating_add(index), ..first })
        });
        for buffer in interface.loose.iter().map(|(slot, _)| *slot).chain(blocks) {
            slots.add(buffer, SlotKind::Buffer);
        }
        // The viewport's size, where points are drawn as quads.
        slots.add(viewport_slot(interface), SlotKind::Buffer);
        for row in &interface.samplers {
            slots.add(row.texture, SlotKind::Texture);
            if row.sampler != row.texture {
                slots.add(row.sampler, SlotKind::Sampler);
            }
        }
        slots
    }

    fn add(&mut self, binding: SlotBinding, kind: SlotKind) {
        let next = self.0.values().filter(|(other, _)| *other == kind).count() as u32;
        self.0.entry(binding).or_insert((kind, next));
    }

    /// The kind and the number of a binding.
    pub(crate) fn get(&self, group: u32, binding: u32) -> Option<(SlotKind, u32)> {
        self.0.get(&SlotBinding { group, binding }).copied()
    }

    /// The number of a binding.
    pub(crate) fn number(&self, slot: SlotBinding) -> Option<u32> {
        self.0.get(&slot).map(|(_, number)| *number)
    }
}

impl SlotKind {
    /// How many numbers of this kind a stage has in a target: Metal's feature set tables, Direct3D 11 §16.1.
    pub(crate) fn limit(self, target: Target) -> u32 {
        match (target, self) {
            (Target::Hlsl, Self::Buffer) => 14,
            (Target::Hlsl, Self::Texture) => 128,
            (_, Self::Buffer | Self::Texture) => 31,
            (_, Self::Sampler) => 16,
        }
    }

    /// The name for messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Buffer => "uniform buffers",
            Self::Texture => "textures",
            Self::Sampler => "samplers",
        }
    }
}

/// The binding of the uniform buffer with the viewport's size, where points are drawn as quads
/// ([`Conventions::point_sprites`](crate::Conventions::point_sprites)): after all others of its group.
pub fn viewport_slot(interface: &Interface) -> SlotBinding {
    let blocks: u32 = interface.blocks.iter().map(|block| block.array_size.unwrap_or(1)).sum();
    let binding = u32::from(interface.loose.is_some()).saturating_add(blocks);
    SlotBinding { group: 0, binding }
}
