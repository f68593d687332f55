//! The bindings of a program, its color targets, and how its code is emitted.
//!
//! *In:* a program, a draw. *Out:* bindings, targets, conventions. *Holds:* bindings count from 0 without gaps in each group, as the
//! reflection has them: a host numbers those of a layout so.

use crate::states::{blend, color_format};
use crate::{Error, slots, sprites};
use glisten_emit::{self as emit, Conventions, Target, TexelWrap};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::targets::FEATURE_NOT_IN_TARGET;
use glisten_front::hir::{SamplerDim, SamplerType, Scalar, Type};
use glisten_front::link::{Program, SlotBinding};
use glisten_front::source::Span;
use glisten_scene::{Draw, Format, Framebuffer, Wrap};
use wgpu_types as wgpu;

/// Group 0 holds the uniform buffers, group 1 the textures and samplers.
pub const GROUPS: usize = 2;

/// The conventions for emission.
pub fn conventions(framebuffer: &Framebuffer, draw: &Draw, target: Target) -> Conventions {
    Conventions {
        texel_wrap: texel_wraps(draw).next().unwrap_or_default(),
        color_attachments: Some(framebuffer.attachments),
        point_sprites: sprites::applies(draw, target),
        clip_distances: Some(draw.state.clip_distances),
        program_point_size: draw.state.program_point_size,
        ..Conventions::default()
    }
}

/// The wrap modes of the integer textures of a draw whose texels the code looks for.
fn texel_wraps(draw: &Draw) -> impl Iterator<Item = TexelWrap> {
    let has_mode = |kind: SamplerType| {
        kind.texel != Scalar::Float && matches!(kind.dim, SamplerDim::D1 | SamplerDim::D2 | SamplerDim::D3)
    };
    let textures = draw.textures.iter().flatten().filter(move |texture| has_mode(texture.kind));
    textures.map(|texture| match texture.wrap {
        Wrap::Repeat => TexelWrap::Repeat,
        Wrap::ClampToEdge => TexelWrap::ClampToEdge,
        Wrap::MirroredRepeat => TexelWrap::MirroredRepeat,
    })
}

/// Rejects integer textures of several wrap modes in one draw: its code has one for all of them.
///
/// # Errors
/// The draw has such textures.
pub fn refuse_wraps(draw: &Draw) -> Result<(), Error> {
    let mut modes = texel_wraps(draw);
    let first = modes.next();
    match modes.all(|mode| Some(mode) == first) {
        true => Ok(()),
        false => {
            let message = "the integer textures of this draw have different wrap modes, and the code, which computes their texels, has one";
            let help = "give them one `wrap`, or draw by `--backend gl` or `cpu`";
            let told = Diagnostic::new(&FEATURE_NOT_IN_TARGET, Span::default(), message).help(help);
            Err(Error::Emit(vec![told]))
        }
    }
}

/// Rejects comparisons at explicit levels of detail, which are compiled only for depth textures of one level.
///
/// # Errors
/// The draw has such a comparison.
pub fn refuse_levels(draw: &Draw) -> Result<(), Error> {
    let deep = draw
        .textures
        .iter()
        .flatten()
        .any(|texture| texture.kind.shadow && texture.levels.len() > 1 && texture.filter.uses_levels());
    match emit::levels_of_comparisons(&draw.program).next().filter(|_| deep) {
        Some((span, help)) => {
            let message = "no target compares depth in a level of detail of the shader's choice, and this depth texture has several";
            Err(Error::Emit(vec![Diagnostic::new(&FEATURE_NOT_IN_TARGET, span, message).help(help)]))
        }
        None => Ok(()),
    }
}

/// The color targets. An attachment without an output keeps its clear color.
pub fn targets(framebuffer: &Framebuffer, draw: &Draw) -> Vec<Option<wgpu::ColorTargetState>> {
    let floats = matches!(framebuffer.format, Format::Rgba32Float | Format::Rgba16Float | Format::Rgba8Unorm);
    (0..framebuffer.attachments)
        .map(|location| {
            let written = draw.program.writes_color(location);
            Some(wgpu::ColorTargetState {
                format: color_format(framebuffer.format),
                blend: draw.state.blend.filter(|_| floats).map(blend),
                write_mask: if written { wgpu::ColorWrites::ALL } else { wgpu::ColorWrites::empty() },
            })
        })
        .collect()
}

/// A binding of the layout.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// The place.
    pub slot: SlotBinding,
    /// The kind.
    pub what: What,
}

/// The kind of a bound resource.
#[derive(Clone, Copy, Debug)]
pub enum What {
    /// A uniform buffer.
    Uniforms,
    /// The texture of a sampler type.
    Texture(SamplerType),
    /// The sampler of a sampler type.
    Sampler(SamplerType),
}

impl What {
    /// The type in a layout.
    pub fn layout(self) -> wgpu::BindingType {
        match self {
            Self::Uniforms => wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            Self::Texture(kind) => slots::texture_binding(kind),
            Self::Sampler(kind) => slots::sampler_binding(kind),
        }
    }
}

/// Everything that the interface reflects, by binding.
///
/// # Errors
/// Bindings do not count from 0 without gaps in each group.
pub fn bindings(program: &Program, sprites: bool) -> Result<Vec<Binding>, Error> {
    let interface = &program.interface;
    let mut all: Vec<Binding> = Vec::new();
    all.extend(interface.loose.iter().map(|&(slot, _)| Binding { slot, what: What::Uniforms }));
    for block in &interface.blocks {
        for element in 0..block.array_size.unwrap_or(1) {
            let slot = SlotBinding { binding: block.slot.binding + element, ..block.slot };
            all.push(Binding { slot, what: What::Uniforms });
        }
    }
    if sprites {
        all.push(Binding { slot: sprites::slot(program), what: What::Uniforms });
    }
    for sampler in &interface.samplers {
        let Type::Sampler(kind) = program.types.get(sampler.ty) else { continue };
        all.push(Binding { slot: sampler.texture, what: What::Texture(kind) });
        if sampler.sampler != sampler.texture {
            all.push(Binding { slot: sampler.sampler, what: What::Sampler(kind) });
        }
    }
    all.sort_by_key(|binding| binding.slot);
    let mut next = [0; GROUPS];
    for binding in &all {
        match next.get_mut(binding.slot.group as usize) {
            Some(next) if *next == binding.slot.binding => *next += 1,
            _ => {
                return Err(Error::Refused(format!(
                    "the bindings of program `{}` are not dense at group {}, binding {}",
                    program.name, binding.slot.group, binding.slot.binding
                )));
            }
        }
    }
    Ok(all)
}
