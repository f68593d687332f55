//! Overload resolution (§6.1): an exact match, or else the only match by implicit conversions.

use super::convert::converts;
use crate::hir::{ParamMode, TypeId, Types};

/// The result of overload resolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Resolution {
    /// The candidate with this index.
    Found(usize),
    /// Several candidates match by conversions; these are the first two.
    Ambiguous(usize, usize),
    /// No candidate matches.
    Missing,
}

/// How a candidate matches the arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fit {
    Exact,
    Converted,
    None,
}

/// Resolves a call among candidates, each given by its parameters.
pub(super) fn resolve<P>(types: &Types, arguments: &[TypeId], candidates: impl Iterator<Item = P>) -> Resolution
where
    P: IntoIterator<Item = (TypeId, ParamMode)>,
{
    let mut found = Resolution::Missing;
    for (index, params) in candidates.enumerate() {
        match fit(types, arguments, params) {
            Fit::Exact => return Resolution::Found(index),
            Fit::Converted => {
                found = match found {
                    Resolution::Missing => Resolution::Found(index),
                    Resolution::Found(first) => Resolution::Ambiguous(first, index),
                    ambiguous @ Resolution::Ambiguous(..) => ambiguous,
                }
            }
            Fit::None => {}
        }
    }
    found
}

fn fit(types: &Types, arguments: &[TypeId], params: impl IntoIterator<Item = (TypeId, ParamMode)>) -> Fit {
    let mut best = Fit::Exact;
    let mut arguments = arguments.iter();
    for (param, mode) in params {
        let Some(&argument) = arguments.next() else { return Fit::None };
        if argument == param {
            continue;
        }
        let inward = converts(types, argument, param);
        let outward = converts(types, param, argument);
        let possible = match mode {
            ParamMode::In | ParamMode::ConstIn => inward,
            ParamMode::Out => outward,
            ParamMode::Inout => inward && outward,
        };
        if !possible {
            return Fit::None;
        }
        best = Fit::Converted;
    }
    if arguments.next().is_some() { Fit::None } else { best }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hir::Scalar;

    const IVEC4: TypeId = TypeId::vector(Scalar::Int, 4);

    /// The example of §6.1.
    #[test]
    fn the_example_of_the_specification() {
        let types = Types::new();
        let functions = [
            [(TypeId::VEC4, ParamMode::In), (TypeId::VEC4, ParamMode::Out)],
            [(TypeId::VEC4, ParamMode::In), (IVEC4, ParamMode::Out)],
        ];
        let call = |arguments: [TypeId; 2]| resolve(&types, &arguments, functions.iter().copied());
        assert_eq!(call([TypeId::VEC4, TypeId::VEC4]), Resolution::Found(0));
        assert_eq!(call([TypeId::VEC4, IVEC4]), Resolution::Found(1));
        assert_eq!(call([IVEC4, TypeId::VEC4]), Resolution::Ambiguous(0, 1));
        assert_eq!(call([IVEC4, IVEC4]), Resolution::Found(1));
        assert_eq!(call([TypeId::BOOL, TypeId::VEC4]), Resolution::Missing);
    }
}
