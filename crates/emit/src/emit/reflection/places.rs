//! Where a program's resources are in each target, and which stages see them: what the layout of a bind group needs
//! besides bindings, Metal's indices, Direct3D's registers, the names in GLSL.
//!
//! *In:* a [`Program`] and [`Conventions`]. *Out:* parts of the [`Reflection`](super::Reflection). *Holds:* it agrees
//! with the emitted text; a test compares them.

use crate::emit::targets::{glsl, native};
use crate::target::{Conventions, Slots, WindowOrigin, viewport_slot};
use glisten_front::hir::{GlobalId, Stage};
use glisten_front::link::{Program, SlotBinding};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The names and versions of the targets.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Targets {
    /// Metal.
    pub msl: MslTarget,
    /// Direct3D.
    pub hlsl: HlslTarget,
    /// OpenGL and WebGL.
    pub glsl: GlslTarget,
}

/// MSL.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MslTarget {
    /// The version of the language.
    pub version: String,
    /// The names of the entry points. Attributes are `[[attribute(location)]]`.
    pub entry_points: super::EntryPoints,
}

/// HLSL.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct HlslTarget {
    /// The shader model.
    pub shader_model: String,
    /// The semantic of attributes and varyings, which the location follows.
    pub semantic: String,
}

/// GLSL. Its conventions are OpenGL's: clip-space z in [-w, w], the window's origin at the lower left, the last vertex
/// provoking.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct GlslTarget {
    /// `330`, `450`, `300es`, `vulkan`
    pub version: String,
    /// The names that the version does not allow, each with the one in the text. All others are the source's own.
    pub renamed: BTreeMap<String, String>,
}

/// The index of a uniform buffer in Metal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MslBuffer {
    /// `[[buffer(n)]]`
    pub buffer: u32,
}

/// The register of a uniform buffer in Direct3D.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct HlslBuffer {
    /// `b0`
    pub register: String,
}

/// The indices of a texture and its sampler in Metal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MslTexture {
    /// `[[texture(n)]]`
    pub texture: u32,
    /// `[[sampler(n)]]`; none if there is no sampler.
    pub sampler: Option<u32>,
}

/// The registers of a texture and its sampler in Direct3D.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct HlslTexture {
    /// `t0`
    pub texture: String,
    /// `s0`; none if there is no sampler.
    pub sampler: Option<String>,
}

/// How a host draws points as quads: each point is an instance, attributes advance with instances.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PointSprites {
    /// The number of vertices of an instance.
    pub vertices: u32,
    /// The topology, in WebGPU's terms: `triangle-strip`.
    pub topology: String,
    /// The step mode of all vertex buffers, in WebGPU's terms: `instance`.
    pub step_mode: String,
    /// The group of the uniform buffer for the viewport's size.
    pub group: u32,
    /// Its binding.
    pub binding: u32,
    /// Its size: two `float`s, the viewport's width and height in pixels.
    pub size: u32,
    /// Its register in HLSL.
    pub hlsl: HlslBuffer,
}

/// The stages, by name, in pipeline order.
pub type Visibility = Vec<String>;

/// Finds places.
pub(super) struct Places<'a> {
    program: &'a Program,
    conventions: &'a Conventions,
    slots: Slots,
}

impl<'a> Places<'a> {
    pub(super) fn new(program: &'a Program, conventions: &'a Conventions) -> Self {
        Self { program, conventions, slots: Slots::of(&program.interface) }
    }

    fn number(&self, slot: SlotBinding) -> u32 {
        self.slots.number(slot).unwrap_or_default()
    }

    pub(super) fn buffer(&self, slot: SlotBinding) -> (MslBuffer, HlslBuffer) {
        let buffer = self.number(slot);
        (MslBuffer { buffer }, HlslBuffer { register: format!("b{buffer}") })
    }

    pub(super) fn texture(&self, texture: SlotBinding, sampler: SlotBinding) -> (MslTexture, HlslTexture) {
        let sampler = (sampler != texture).then(|| self.number(sampler));
        let texture = self.number(texture);
        let hlsl =
            HlslTexture { texture: format!("t{texture}"), sampler: sampler.map(|sampler| format!("s{sampler}")) };
        (MslTexture { texture, sampler }, hlsl)
    }

    /// The stages that use one of these variables.
    pub(super) fn visibility(&self, globals: &[(Stage, GlobalId)]) -> Visibility {
        let uses = |stage: Stage| {
            let own = globals.iter().filter(|(of, _)| *of == stage);
            self.program.stage(stage).is_some_and(|shader| {
                own.map(|(_, global)| *global).any(|global| shader.globals.get(global.index()).is_some_and(|g| g.used))
            })
        };
        Stage::ALL.into_iter().filter(|stage| uses(*stage)).map(|stage| stage.name().to_owned()).collect()
    }

    /// The stages that see the block of the loose uniforms.
    pub(super) fn loose_visibility(&self) -> Visibility {
        let interface = &self.program.interface;
        let loose = interface.roots.iter().filter(|root| root.block.is_none());
        let mut globals: Vec<(Stage, GlobalId)> = loose.flat_map(|root| root.globals.clone()).collect();
        let counted = interface.samplers.iter().filter(|slot| slot.texel_count.is_some());
        globals.extend(counted.flat_map(|slot| slot.globals.clone()));
        let mut seen = self.visibility(&globals);
        let upper_left = self.conventions.window_origin == WindowOrigin::UpperLeft;
        let fragment = Stage::Fragment.name();
        if upper_left && interface.framebuffer_height.is_some() && !seen.iter().any(|stage| stage == fragment) {
            seen.push(fragment.to_owned());
        }
        seen
    }

    /// How points are drawn, if they are drawn as quads.
    pub(super) fn point_sprites(&self) -> Option<PointSprites> {
        let slot = viewport_slot(&self.program.interface);
        let (_, hlsl) = self.buffer(slot);
        let has_vertex = self.program.stage(Stage::Vertex).is_some();
        (self.conventions.point_sprites && has_vertex).then(|| PointSprites {
            vertices: 4,
            topology: "triangle-strip".to_owned(),
            step_mode: "instance".to_owned(),
            group: slot.group,
            binding: slot.binding,
            size: 8,
            hlsl,
        })
    }

    /// The names and versions of the targets.
    pub(super) fn targets(&self) -> Targets {
        let version = self.conventions.glsl_version;
        let entry = |stage: Stage| {
            let shader = self.program.stage(stage).filter(|shader| shader.main.is_some());
            shader.map(|_| native::msl_entry_point(stage).to_owned())
        };
        let entry_points =
            super::EntryPoints { vertex: entry(Stage::Vertex), geometry: None, fragment: entry(Stage::Fragment) };
        Targets {
            msl: MslTarget { version: "2.3".to_owned(), entry_points },
            hlsl: HlslTarget { shader_model: "5.0".to_owned(), semantic: "LOC".to_owned() },
            glsl: GlslTarget { version: version.word().to_owned(), renamed: glsl::renamed(self.program, version) },
        }
    }
}
