//! [`Fixed`]: uniforms that a build fixes.
//!
//! *In:* names and numbers, and a program. *Out:* the program without what they make needless. *Holds:* a program without the
//! uniform is unchanged, and the numbers take the type that it has.

use super::error::BuildError;
use super::found::Found;
use glisten_front::Program;
use glisten_front::diagnostic::did_you_mean;
use glisten_front::hir::{Scalar, ScalarValue, Type};
use glisten_front::link::UniformLeaf;
use glisten_front::source::SourceMap;
use glisten_specialize::{Known, Options, specialize_with};

/// A uniform with the numbers of its components.
#[derive(Clone, Debug)]
pub(super) struct Fixed {
    pub(super) name: String,
    pub(super) numbers: Vec<f64>,
}

/// Whether some program has each fixed uniform. Programs with errors may have any.
pub(super) fn check(fixed: &[Fixed], found: &Found) -> Result<(), BuildError> {
    let names = || found.programs.iter().flat_map(|one| &one.program.interface.uniforms).map(|leaf| leaf.name.as_str());
    let unknown = fixed.iter().find(|one| !names().any(|name| name == one.name));
    match unknown {
        Some(one) if found.errors.is_empty() => {
            let similar = did_you_mean(&one.name, names()).map(str::to_owned);
            Err(BuildError::NoUniform { uniform: one.name.clone(), similar })
        }
        _ => Ok(()),
    }
}

/// The program without what fixed uniforms make needless.
pub(super) fn without_known(fixed: &[Fixed], program: Program, sources: &SourceMap) -> Result<Program, BuildError> {
    let mut known = Known::default();
    for one in fixed {
        let Some(leaf) = program.interface.uniforms.iter().find(|leaf| leaf.name == one.name) else { continue };
        known.uniforms.insert(one.name.clone(), one.scalars(&program, leaf)?);
    }
    if known.uniforms.is_empty() {
        return Ok(program);
    }
    let options = Options { sources: Some(sources), ..Options::default() };
    let residual = specialize_with(&program, &known, &options);
    Ok(if residual.fault.is_none() { residual.program } else { program })
}

impl Fixed {
    /// The numbers as scalars of the uniform's type.
    fn scalars(&self, program: &Program, leaf: &UniformLeaf) -> Result<Vec<ScalarValue>, BuildError> {
        let wanted = program.types.flat_len(leaf.ty) * leaf.array_size.unwrap_or(1);
        let scalar = match program.types.get(leaf.ty) {
            Type::Scalar(scalar) | Type::Vector(scalar, _) => scalar,
            _ => Scalar::Float,
        };
        if wanted as usize != self.numbers.len() {
            return Err(BuildError::Fixed { uniform: self.name.clone(), wanted, given: self.numbers.len() });
        }
        Ok(self.numbers.iter().map(|number| typed(*number, scalar)).collect())
    }
}

fn typed(number: f64, scalar: Scalar) -> ScalarValue {
    match scalar {
        Scalar::Float => ScalarValue::Float(number as f32),
        Scalar::Int => ScalarValue::Int(number as i32),
        Scalar::Uint => ScalarValue::Uint(number as u32),
        Scalar::Bool => ScalarValue::Bool(number != 0.0),
    }
}
