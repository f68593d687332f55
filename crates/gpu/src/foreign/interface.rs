//! [`Interface`]: what a module shows of its interface.
//!
//! *In:* naga's module. *Out:* locations with their types, resources by group and binding, the scalars of uniform blocks
//! by their offsets. *Holds:* two modules for one pipeline that lay out data alike have equal parts, whatever types they
//! wrap it in.

use super::read::naga_stage;
use glisten_front::hir::Stage;
use naga::{
    AddressSpace, ArraySize, Binding, Handle, ImageClass, ImageDimension, Interpolation, Module, Sampling, Scalar,
    ScalarKind, Type, TypeInner,
};
use std::collections::BTreeMap;
use std::fmt;

/// The largest uniform block in bytes (WebGPU's `maxUniformBufferBindingSize`).
const MAX_BLOCK: u32 = 65_536;

/// More locations than any stage passes.
const MAX_LOCATIONS: u32 = 256;

/// An input or output with a location.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Slot {
    pub(super) scalar: Scalar,
    pub(super) components: u8,
    pub(super) interpolation: Option<Interpolation>,
    pub(super) sampling: Option<Sampling>,
}

/// A bound resource.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Resource {
    /// A uniform block: the kinds of its scalars by offset.
    Uniforms(BTreeMap<u32, ScalarKind>),
    Texture(ImageDimension, bool, ImageClass),
    Sampler {
        comparison: bool,
    },
    Other,
}

/// The interface of an entry point.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Interface {
    pub(super) inputs: BTreeMap<u32, Slot>,
    pub(super) outputs: BTreeMap<u32, Slot>,
    pub(super) resources: BTreeMap<(u32, u32), Resource>,
}

impl Interface {
    /// The interface of the module's entry point for a stage.
    pub(super) fn of(module: &Module, stage: Stage) -> Result<Self, String> {
        let mut found = Self::default();
        let entry = module.entry_points.iter().find(|entry| Some(entry.stage) == naga_stage(stage));
        let entry = entry.ok_or_else(|| format!("it has no entry point for the {} stage", stage.name()))?;
        for argument in &entry.function.arguments {
            slots(module, argument.ty, argument.binding.as_ref(), &mut found.inputs)?;
        }
        if let Some(result) = &entry.function.result {
            slots(module, result.ty, result.binding.as_ref(), &mut found.outputs)?;
        }
        for (_, global) in module.global_variables.iter() {
            let Some(binding) = &global.binding else { continue };
            let resource = match (&module.types[global.ty].inner, global.space) {
                (TypeInner::Image { dim, arrayed, class }, _) => Resource::Texture(*dim, *arrayed, *class),
                (TypeInner::Sampler { comparison }, _) => Resource::Sampler { comparison: *comparison },
                (_, AddressSpace::Uniform) => Resource::Uniforms(block(module, global.ty)?),
                _ => Resource::Other,
            };
            if found.resources.insert((binding.group, binding.binding), resource).is_some() {
                return Err(format!("two resources have group {}, binding {}", binding.group, binding.binding));
            }
        }
        Ok(found)
    }
}

/// Adds an argument or a result, or its members.
fn slots(
    module: &Module,
    ty: Handle<Type>,
    binding: Option<&Binding>,
    to: &mut BTreeMap<u32, Slot>,
) -> Result<(), String> {
    if let (TypeInner::Struct { members, .. }, None) = (&module.types[ty].inner, binding) {
        return members.iter().try_for_each(|member| slots(module, member.ty, member.binding.as_ref(), to));
    }
    let Some(&Binding::Location { location, interpolation, sampling, .. }) = binding else { return Ok(()) };
    // A matrix has a location for each column, an array for each element (GLSL 1.50 §4.3.4, Vulkan: Location Assignment).
    let (ty, count) = match module.types[ty].inner {
        TypeInner::Array { base, size: ArraySize::Constant(count), .. } => (base, count.get()),
        _ => (ty, 1),
    };
    let (scalar, components, columns) = match module.types[ty].inner {
        TypeInner::Scalar(scalar) => (scalar, 1, 1),
        TypeInner::Vector { size, scalar } => (scalar, size as u8, 1),
        TypeInner::Matrix { columns, rows, scalar } => (scalar, rows as u8, columns as u32),
        _ => return Err(format!("location {location} has a type that no stage passes")),
    };
    if count > MAX_LOCATIONS || location > MAX_LOCATIONS {
        return Err(format!("location {location} is beyond all that a stage passes"));
    }
    for location in location..location + count * columns {
        if to.insert(location, Slot { scalar, components, interpolation, sampling }).is_some() {
            return Err(format!("two inputs or outputs have location {location}"));
        }
    }
    Ok(())
}

/// The scalars of a uniform block.
fn block(module: &Module, ty: Handle<Type>) -> Result<BTreeMap<u32, ScalarKind>, String> {
    let mut scalars = BTreeMap::new();
    let mut rest = vec![(0_u32, ty)];
    while let Some((offset, ty)) = rest.pop() {
        if offset >= MAX_BLOCK || rest.len() as u32 > MAX_BLOCK {
            return Err(format!("a uniform block has more than {MAX_BLOCK} bytes"));
        }
        let each = |count: u32, stride: u32| {
            (0..count.min(MAX_BLOCK)).map(move |i| offset.saturating_add(i.saturating_mul(stride)))
        };
        match &module.types[ty].inner {
            TypeInner::Scalar(scalar) => {
                scalars.insert(offset, scalar.kind);
            }
            TypeInner::Vector { size, scalar } => {
                scalars.extend(each(*size as u32, u32::from(scalar.width)).map(|at| (at, scalar.kind)));
            }
            TypeInner::Matrix { columns, rows, scalar } => {
                let stride = if *rows as u32 == 2 { 2 } else { 4 } * u32::from(scalar.width);
                for column in each(*columns as u32, stride) {
                    let rows = (0..*rows as u32).map(|row| (column + row * u32::from(scalar.width), scalar.kind));
                    scalars.extend(rows);
                }
            }
            TypeInner::Array { base, size: ArraySize::Constant(count), stride } => {
                if u64::from(count.get()) * u64::from((*stride).max(1)) > u64::from(MAX_BLOCK) {
                    return Err(format!("a uniform block has more than {MAX_BLOCK} bytes"));
                }
                rest.extend(each(count.get(), *stride).map(|at| (at, *base)));
            }
            TypeInner::Struct { members, .. } => {
                rest.extend(members.iter().map(|member| (offset.saturating_add(member.offset), member.ty)));
            }
            _ => return Err("a uniform block has a member that no uniform block has".to_owned()),
        }
    }
    Ok(scalars)
}

/// The type as WGSL writes it, with the interpolation unless it is the usual one.
impl fmt::Display for Slot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scalar = kind(self.scalar.kind);
        match self.components {
            1 => f.write_str(scalar)?,
            count => write!(f, "vec{count}<{scalar}>")?,
        }
        match self.interpolation {
            None | Some(Interpolation::Perspective) => {}
            Some(Interpolation::Linear) => f.write_str(" noperspective")?,
            Some(Interpolation::Flat) => f.write_str(" flat")?,
            Some(_) => f.write_str(" by another interpolation")?,
        }
        match self.sampling {
            Some(Sampling::Centroid) => f.write_str(" centroid"),
            Some(Sampling::Sample) => f.write_str(" sample"),
            _ => Ok(()),
        }
    }
}

impl fmt::Display for Resource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Uniforms(_) => f.write_str("a uniform block"),
            Self::Sampler { comparison: false } => f.write_str("a sampler"),
            Self::Sampler { comparison: true } => f.write_str("a comparison sampler"),
            Self::Texture(dim, arrayed, class) => {
                let dim = match dim {
                    ImageDimension::D1 => "1D",
                    ImageDimension::D2 => "2D",
                    ImageDimension::D3 => "3D",
                    ImageDimension::Cube => "cube",
                };
                let class = match class {
                    ImageClass::Depth { .. } => "depth".to_owned(),
                    ImageClass::Sampled { kind: of, .. } => kind(*of).to_owned(),
                    _ => "other".to_owned(),
                };
                write!(f, "a {dim}{} texture of {class}", if *arrayed { " array" } else { "" })
            }
            Self::Other => f.write_str("something else"),
        }
    }
}

/// The name of a kind of scalars.
pub(super) fn kind(kind: ScalarKind) -> &'static str {
    match kind {
        ScalarKind::Sint => "i32",
        ScalarKind::Uint => "u32",
        ScalarKind::Float => "f32",
        ScalarKind::Bool => "bool",
        ScalarKind::AbstractInt | ScalarKind::AbstractFloat => "a constant",
    }
}
