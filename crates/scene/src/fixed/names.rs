//! The state under the names that shaders have for it (GLSL 1.20 §7.5): `gl_LightSource[0].position`.
//!
//! *In:* a name and numbers. *Out:* the state with that value, or the values of a uniform, flat. *Holds:* only what a host
//! sets can be set; derived values follow from it.

use super::derived::FORMS;
use super::state::{FixedFunction, LightSource};
use glam::DMat4;
use glisten_front::hir::{ScalarValue, Storage};
use glisten_front::link::{Program, UniformRoot};
use std::fmt;

/// Why a value cannot be set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SetError {
    /// There is no such state, or it is derived.
    Unknown,
    /// It takes another number of values.
    Count {
        /// That number.
        wanted: usize,
    },
}

impl fmt::Display for SetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown => write!(f, "the fixed-function pipeline has no such state"),
            Self::Count { wanted } => write!(f, "it takes {wanted} numbers"),
        }
    }
}

impl std::error::Error for SetError {}

/// Whether a uniform is state of the fixed-function pipeline.
pub fn is_fixed_uniform(name: &str) -> bool {
    let rows = glisten_front::builtin::fixed::FIXED.iter();
    rows.filter(|row| row.storage == Storage::Uniform).any(|row| row.name == name)
}

/// Whether a program reads state of the fixed-function pipeline.
pub fn uses_fixed_state(program: &Program) -> bool {
    program.interface.roots.iter().any(|root| root.block.is_none() && is_fixed_uniform(&root.name))
}

/// The initial current value of an attribute of the fixed-function pipeline (OpenGL 2.1 table 6.5), which all vertices have
/// without data. A vertex has no such position.
pub fn current_attribute(name: &str) -> Option<Vec<f32>> {
    match name {
        "gl_Color" => Some(vec![1.0; 4]),
        "gl_SecondaryColor" => Some(vec![0.0, 0.0, 0.0, 1.0]),
        "gl_Normal" => Some(vec![0.0, 0.0, 1.0]),
        "gl_FogCoord" => Some(vec![0.0]),
        _ => name.starts_with("gl_MultiTexCoord").then(|| vec![0.0, 0.0, 0.0, 1.0]),
    }
}

impl FixedFunction {
    /// Sets state by its name: `gl_ModelViewMatrix`, `gl_TextureMatrix[1]`, `gl_Fog.density`. The name of an array sets
    /// all its elements.
    ///
    /// # Errors
    /// [`SetError`] if there is no such state, or another number of values.
    pub fn set(&mut self, name: &str, values: &[f64]) -> Result<(), SetError> {
        let (root, index, member) = path(name).ok_or(SetError::Unknown)?;
        let mut rest = values;
        let (mut found, mut wanted) = (false, 0);
        let mut updated = self.clone();
        updated.visit(&mut |known, at, part, slot| {
            if known == root && part == member && index.is_none_or(|index| index == at) {
                found = true;
                wanted += slot.len();
                let (own, more) = rest.split_at(slot.len().min(rest.len()));
                slot.iter_mut().zip(own).for_each(|(slot, value)| *slot = *value);
                rest = more;
            }
        });
        match (found, wanted == values.len()) {
            (false, _) => Err(SetError::Unknown),
            (true, false) => Err(SetError::Count { wanted }),
            (true, true) => {
                *self = updated;
                Ok(())
            }
        }
    }

    /// The values of a uniform, set or derived, in flat order; `None` for a name that is no state.
    pub fn uniform(&self, name: &str) -> Option<Vec<f64>> {
        let state = self.rounded();
        if let Some(matrices) = state.matrices(name) {
            return Some(matrices);
        }
        let listed = |product: [f64; 4]| Some(product.to_vec());
        match name {
            "gl_NormalMatrix" => Some(state.normal_matrix().to_cols_array().to_vec()),
            "gl_NormalScale" => Some(vec![state.normal_scale()]),
            "gl_FrontLightModelProduct" => listed(state.scene_color(&state.front)),
            "gl_BackLightModelProduct" => listed(state.scene_color(&state.back)),
            "gl_FrontLightProduct" => Some(state.light_products(&state.front)),
            "gl_BackLightProduct" => Some(state.light_products(&state.back)),
            "gl_LightSource" => Some(state.lights.iter().flat_map(light).collect()),
            _ => {
                let mut values = Vec::new();
                let scale = state.fog.scale();
                let mut state = state;
                state.visit(&mut |known, _, _, slot| {
                    if known == name {
                        values.extend_from_slice(slot);
                    }
                });
                values.extend((name == "gl_Fog").then_some(scale));
                (!values.is_empty()).then_some(values)
            }
        }
    }

    /// Whether there is state of this name, which a host sets: an array, a struct, an element or a member.
    pub fn has(name: &str) -> bool {
        let Some((root, index, member)) = path(name) else { return false };
        let mut found = false;
        Self::default().visit(&mut |known, at, part, _| found |= is_part(known == root, (index, member), (at, part)));
        found
    }

    /// Which values of a uniform, in flat order, follow from state of this name: of `gl_ModelViewMatrix` all of `gl_NormalMatrix`. `None` if
    /// there is no such state, or no such uniform.
    pub fn follow(name: &str, uniform: &str) -> Option<Vec<bool>> {
        let (root, index, member) = path(name)?;
        // Values of no meaning: what is derived differs only where it follows from what differs.
        let (mut before, mut count) = (Self::default(), 0.0);
        before.visit(&mut |_, _, _, slot| {
            for value in slot {
                count += 1.0;
                *value = 1.0 + (count * 0.618_f64).fract();
            }
        });
        let (mut after, mut found) = (before.clone(), false);
        after.visit(&mut |known, at, part, slot| {
            let is_named = is_part(known == root, (index, member), (at, part));
            found |= is_named;
            for (place, value) in slot.iter_mut().enumerate().filter(|_| is_named) {
                *value += 0.125 * (place as f64 + 1.0).sqrt();
            }
        });
        let (before, after) = (before.uniform(uniform)?, after.uniform(uniform)?);
        found.then(|| before.iter().zip(&after).map(|(before, after)| before != after).collect())
    }

    /// The values of a root of a program, rounded once.
    pub fn root_values(&self, root: &UniformRoot) -> Option<Vec<ScalarValue>> {
        let values = self.uniform(&root.name).filter(|_| root.block.is_none())?;
        Some(values.into_iter().map(|value| ScalarValue::Float(value as f32)).collect())
    }

    /// A matrix or an array of matrices, in the form that the name asks for.
    fn matrices(&self, name: &str) -> Option<Vec<f64>> {
        let (base, form) = FORMS.iter().find_map(|(end, form)| Some((name.strip_suffix(end)?, form)))?;
        let flat = |matrices: &[DMat4]| matrices.iter().flat_map(|&matrix| form(matrix).to_cols_array()).collect();
        match base {
            "gl_ModelViewMatrix" => Some(flat(&[self.model_view])),
            "gl_ProjectionMatrix" => Some(flat(&[self.projection])),
            "gl_ModelViewProjectionMatrix" => Some(flat(&[self.projection * self.model_view])),
            "gl_TextureMatrix" => Some(flat(&self.texture)),
            _ => None,
        }
    }
}

/// Whether an element and member of the root are part of what an index and a member name.
fn is_part(of_root: bool, (index, member): (Option<usize>, &str), (at, part): (usize, &str)) -> bool {
    of_root && index.is_none_or(|index| index == at) && (member.is_empty() || member == part)
}

/// The root of a name of state, its index and its member: of `gl_LightSource[0].position`. `None` if the index is none.
fn path(name: &str) -> Option<(&str, Option<usize>, &str)> {
    let (path, member) = name.split_once('.').unwrap_or((name, ""));
    match path.strip_suffix(']').and_then(|path| path.split_once('[')) {
        Some((root, index)) => Some((root, Some(index.parse().ok()?), member)),
        None => Some((path, None, member)),
    }
}

/// The members of `gl_LightSourceParameters`, in order.
fn light(light: &LightSource) -> Vec<f64> {
    let colors = [light.ambient, light.diffuse, light.specular, light.position, light.half_vector()];
    let spot = [light.spot_exponent, light.spot_cutoff, light.spot_cos_cutoff()];
    colors.into_iter().flatten().chain(light.spot_direction).chain(spot).chain(light.attenuation).collect()
}

#[cfg(test)]
mod tests {
    use super::super::UNITS;
    use super::*;
    use glisten_front::builtin::fixed::FIXED;

    #[test]
    fn initial_values_are_those_that_the_front_end_has() {
        let state = FixedFunction::default();
        for row in FIXED.iter().filter(|row| row.storage == Storage::Uniform) {
            let values: Vec<f32> =
                state.uniform(row.name).unwrap_or_default().into_iter().map(|value| value as f32).collect();
            let initial = row.initial();
            assert_eq!(values.len(), initial.len(), "{}", row.name);
            for (at, (value, initial)) in values.iter().zip(&initial).enumerate() {
                assert!((value - initial).abs() < 1e-6, "{}: value {at}, {value} {initial}", row.name);
            }
        }
    }

    #[test]
    fn derived_values_follow_from_what_is_set() {
        let mut state = FixedFunction::default();
        let stretch = DMat4::from_scale(glam::DVec3::new(2.0, 4.0, 8.0));
        assert_eq!(state.set("gl_ModelViewMatrix", &stretch.to_cols_array()), Ok(()));
        let normal = state.uniform("gl_NormalMatrix").unwrap_or_default();
        assert_eq!(normal, [0.5, 0.0, 0.0, 0.0, 0.25, 0.0, 0.0, 0.0, 0.125]);
        assert_eq!(state.uniform("gl_NormalScale"), Some(vec![8.0]));
        let inverse = state.uniform("gl_ModelViewProjectionMatrixInverse").unwrap_or_default();
        assert_eq!((inverse.first(), inverse.get(5)), (Some(&0.5), Some(&0.25)));
        assert_eq!(state.set("gl_LightSource[1].spotCutoff", &[60.0]), Ok(()));
        let lights = state.uniform("gl_LightSource").unwrap_or_default();
        assert!((lights.get(29 + 25).copied().unwrap_or(0.0) - 0.5).abs() < 1e-12);
        assert_eq!(state.set("gl_Fog.end", &[5.0]), Ok(()));
        assert_eq!(state.uniform("gl_Fog").and_then(|fog| fog.last().copied()), Some(0.2));
        assert_eq!(state.set("gl_FrontMaterial.diffuse", &[0.5, 0.5, 0.5, 0.5]), Ok(()));
        let products = state.uniform("gl_FrontLightProduct").unwrap_or_default();
        assert_eq!(products.get(4..8), Some(&[0.5, 0.5, 0.5, 0.5][..]));
        let scene = state.uniform("gl_FrontLightModelProduct").unwrap_or_default();
        assert_eq!(scene.last(), Some(&0.5));
    }

    #[test]
    fn what_follows_from_state_is_known() {
        let follows = |name: &str, uniform: &str| {
            FixedFunction::follow(name, uniform).is_some_and(|values| values.iter().any(|follows| *follows))
        };
        for (name, uniforms) in [
            (
                "gl_ModelViewMatrix",
                &[
                    "gl_ModelViewMatrix",
                    "gl_NormalMatrix",
                    "gl_NormalScale",
                    "gl_ModelViewMatrixInverseTranspose",
                    "gl_ModelViewProjectionMatrix",
                    "gl_ModelViewProjectionMatrixTranspose",
                ][..],
            ),
            ("gl_ProjectionMatrix", &["gl_ProjectionMatrixInverse", "gl_ModelViewProjectionMatrix"]),
            ("gl_TextureMatrix[1]", &["gl_TextureMatrix", "gl_TextureMatrixTranspose"]),
            ("gl_LightSource", &["gl_LightSource", "gl_FrontLightProduct", "gl_BackLightProduct"]),
            ("gl_FrontMaterial", &["gl_FrontMaterial", "gl_FrontLightProduct", "gl_FrontLightModelProduct"]),
            ("gl_LightModel.ambient", &["gl_LightModel", "gl_FrontLightModelProduct", "gl_BackLightModelProduct"]),
            ("gl_Fog.end", &["gl_Fog"]),
            ("gl_NormalMatrix", &[]),
            ("gl_LightSource[x]", &[]),
            ("light", &[]),
        ] {
            for row in FIXED.iter().filter(|row| row.storage == Storage::Uniform) {
                // All forms of a matrix follow from it, whichever the list has.
                let is_listed = uniforms.iter().any(|uniform| {
                    let base = uniform.trim_end_matches("Transpose").trim_end_matches("Inverse");
                    *uniform == row.name
                        || base.ends_with("Matrix") && row.name.starts_with(base) && base != "gl_NormalMatrix"
                });
                assert_eq!(follows(name, row.name), is_listed, "{name}: {}", row.name);
            }
        }
        let half = FixedFunction::follow("gl_LightSource[1].position", "gl_LightSource").unwrap_or_default();
        let of_light: Vec<usize> = (0..half.len()).filter(|at| half[*at]).collect();
        // The position and the half vector of that light, whose last component is 0.
        assert_eq!(of_light, [29 + 12, 29 + 13, 29 + 14, 29 + 15, 29 + 16, 29 + 17, 29 + 18]);
    }

    #[test]
    fn what_is_not_state_is_refused() {
        let mut state = FixedFunction::default();
        for name in ["gl_NormalMatrix", "gl_LightSource[8].position", "gl_LightSource[0].halfVector", "gl_Fog", "x"] {
            assert_eq!(state.set(name, &[0.0]), Err(SetError::Unknown), "{name}");
        }
        assert_eq!(state.set("gl_Fog.color", &[0.0]), Err(SetError::Count { wanted: 4 }));
        assert_eq!(state.set("gl_ClipPlane", &[0.0; 4]), Err(SetError::Count { wanted: 4 * UNITS }));
    }

    #[test]
    fn the_half_vector_is_between_the_light_and_the_viewer() {
        let light = LightSource { position: [3.0, 0.0, 0.0, 0.0], ..LightSource::initial(0) };
        let root = 0.5_f64.sqrt();
        let difference =
            light.half_vector().iter().zip([root, 0.0, root, 0.0]).map(|(a, b)| (a - b).abs()).sum::<f64>();
        assert!(difference < 1e-15);
    }
}
