//! A lowered module with floats of another width: 16 or 64 bits instead of 32.
//!
//! *In:* a module of [`lower`](crate::lower), in f32, and a [`FloatWidth`]. *Out:* the module, in which values, variables,
//! parameters and constants have the other width.
//!
//! *Holds:* the interface keeps its f32: inputs and outputs of the stage, uniforms and textures are converted where they are
//! read and written. So are the arguments of what has no other width: derivatives, lookups, bit casts, and in f64 the
//! functions that GLSL.std.450 defines for 16 and 32 bits only. *Not done here:* the choice of what a target can hold; naga's
//! validator and writers have the last word.

mod expressions;
mod function;
#[cfg(any(not(target_family = "wasm"), feature = "native"))]
mod overflow;
mod rewriter;
mod types;

use crate::target::FloatWidth;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::targets::FEATURE_NOT_IN_TARGET;
use glisten_front::source::Span;
use naga::valid::ModuleInfo;
use naga::{Bytes, Handle, Literal, Module, Type};
use rewriter::Rewriter;
use rustc_hash::{FxHashMap, FxHashSet};

/// Why a module has no other width, in words.
pub(crate) type Refusal = String;

/// The module with floats of another width; `info` is that of the module.
///
/// # Errors
/// A construct that has no other width.
pub(crate) fn in_width(module: &Module, info: &ModuleInfo, floats: FloatWidth) -> Result<Module, Vec<Diagnostic>> {
    let Some(width) = bytes(floats) else { return Ok(module.clone()) };
    rewritten(module, info, width).map_err(|reason| {
        let message = format!("this stage cannot be written in {}: {reason}", floats.ty());
        vec![Diagnostic::new(&FEATURE_NOT_IN_TARGET, Span::default(), message)]
    })
}

/// The width of floats in bytes, if it is another one.
fn bytes(floats: FloatWidth) -> Option<Bytes> {
    match floats {
        FloatWidth::Half => Some(2),
        FloatWidth::Single => None,
        FloatWidth::Double => Some(8),
    }
}

/// A module on its way to another width.
pub(super) struct Widths<'m> {
    old: &'m Module,
    new: Module,
    width: Bytes,
    /// The types of values, by those in f32.
    types: FxHashMap<Handle<Type>, Handle<Type>>,
    /// The types of the stage's inputs and outputs, which stay.
    interface: FxHashSet<Handle<Type>>,
}

fn rewritten(module: &Module, info: &ModuleInfo, width: Bytes) -> Result<Module, Refusal> {
    let entries = module.entry_points.iter().map(|entry| &entry.function);
    let interface = entries
        .flat_map(|entry| entry.arguments.iter().map(|one| one.ty).chain(entry.result.iter().map(|one| one.ty)))
        .filter(|ty| matches!(module.types[*ty].inner, naga::TypeInner::Struct { .. }))
        .collect();
    let mut widths = Widths { old: module, new: module.clone(), width, types: FxHashMap::default(), interface };
    widths.constants()?;
    for (handle, function) in module.functions.iter() {
        let changed = Rewriter::new(&mut widths, function, &info[handle], false).run()?;
        widths.new.functions[handle] = changed;
    }
    for (index, entry) in module.entry_points.iter().enumerate() {
        let changed = Rewriter::new(&mut widths, &entry.function, info.get_entry_point(index), true).run()?;
        if let Some(entry) = widths.new.entry_points.get_mut(index) {
            entry.function = changed;
        }
    }
    #[cfg(any(not(target_family = "wasm"), feature = "native"))]
    if width == 2 {
        overflow::refuse(&widths.new)?;
    }
    Ok(widths.new)
}

impl Widths<'_> {
    /// Constants, and variables of the stage's own.
    fn constants(&mut self) -> Result<(), Refusal> {
        let mut expressions = naga::Arena::new();
        for (handle, expression) in self.old.global_expressions.iter() {
            let changed = match expression {
                naga::Expression::Literal(literal) => naga::Expression::Literal(self.literal(*literal)?),
                naga::Expression::ZeroValue(ty) => naga::Expression::ZeroValue(self.value_type(*ty)?),
                naga::Expression::Compose { ty, components } => {
                    naga::Expression::Compose { ty: self.value_type(*ty)?, components: components.clone() }
                }
                other => other.clone(),
            };
            expressions.append(changed, self.old.global_expressions.get_span(handle));
        }
        self.new.global_expressions = expressions;
        for (handle, constant) in self.old.constants.iter() {
            self.new.constants[handle].ty = self.value_type(constant.ty)?;
        }
        for (handle, variable) in self.old.global_variables.iter() {
            if variable.space == naga::AddressSpace::Private {
                self.new.global_variables[handle].ty = self.value_type(variable.ty)?;
            }
        }
        Ok(())
    }

    /// A number in the other width.
    fn literal(&self, literal: Literal) -> Result<Literal, Refusal> {
        let Literal::F32(value) = literal else { return Ok(literal) };
        if self.width == 8 {
            return Ok(Literal::F64(f64::from(value)));
        }
        let half = half::f16::from_f32(value);
        if half.is_finite() { Ok(Literal::F16(half)) } else { Err(format!("{value} is beyond the range of an f16")) }
    }
}
