//! Which overload a call that is being typed means.
//!
//! *In:* the overloads with the types of their parameters, and the types of the arguments so far. *Out:* the one that they fit best.
//! *Holds:* an argument of which nothing is known fits every parameter. Types are compared by their names, since the call is read apart
//! from the shader.

use lsp_types::SignatureInformation;

/// An overload.
pub(super) struct Overload {
    /// As it is shown.
    pub(super) shown: SignatureInformation,
    /// The types of its parameters; several lists for a row of the language that stands for several overloads. None for a macro.
    pub(super) types: Vec<Vec<String>>,
}

/// The index of the overload that takes these arguments with the fewest conversions; the first of equal ones.
pub(super) fn best(overloads: &[Overload], arguments: &[Option<String>]) -> usize {
    let costs = overloads.iter().enumerate().filter_map(|(index, overload)| Some((overload.cost(arguments)?, index)));
    let enough = |overload: &Overload| {
        overload.shown.parameters.as_ref().is_some_and(|parameters| parameters.len() >= arguments.len())
    };
    costs.min().map(|(_, index)| index).or_else(|| overloads.iter().position(enough)).unwrap_or(0)
}

impl Overload {
    /// The number of conversions that the arguments need. `None` if they do not fit.
    fn cost(&self, arguments: &[Option<String>]) -> Option<usize> {
        self.types.iter().filter_map(|types| cost(types, arguments)).min()
    }
}

fn cost(types: &[String], arguments: &[Option<String>]) -> Option<usize> {
    if types.len() < arguments.len() {
        return None;
    }
    let one = |(ty, argument): (&String, &Option<String>)| match argument {
        Some(argument) if argument == ty => Some(0),
        Some(argument) => converts(argument, ty).then_some(1),
        None => Some(0),
    };
    types.iter().zip(arguments).map(one).sum()
}

/// The types that convert implicitly, by the names of scalars and of vectors without their sizes (GLSL 1.50 §4.1.10).
const CONVERSIONS: [(&str, &str); 6] =
    [("int", "uint"), ("int", "float"), ("uint", "float"), ("ivec", "uvec"), ("ivec", "vec"), ("uvec", "vec")];

fn converts(from: &str, to: &str) -> bool {
    let split = |name: &'_ str| name.trim_end_matches(|letter: char| letter.is_ascii_digit()).len();
    let ((from, size), (to, wanted)) = (from.split_at(split(from)), to.split_at(split(to)));
    size == wanted && CONVERSIONS.contains(&(from, to))
}

#[cfg(test)]
mod tests {
    use super::cost;

    #[test]
    fn arguments_fit_types() {
        let list = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        for (types, arguments, wanted) in [
            (&["vec3", "float"][..], &["vec3"][..], Some(0)),
            (&["vec3", "float"], &["vec3", "int"], Some(1)),
            (&["vec3", "float"], &["ivec3", "uint"], Some(2)),
            (&["vec3", "float"], &["", "float"], Some(0)),
            (&["vec3", "float"], &["float"], None),
            (&["vec3"], &["vec2"], None),
            (&["int"], &["float"], None),
            (&["vec3"], &["vec3", "float"], None),
            (&[], &[], Some(0)),
        ] {
            let arguments: Vec<Option<String>> =
                arguments.iter().map(|name| Some((*name).to_owned()).filter(|name| !name.is_empty())).collect();
            assert_eq!(cost(&list(types), &arguments), wanted, "{types:?} {arguments:?}");
        }
    }
}
