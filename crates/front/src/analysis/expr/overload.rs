//! Overload resolution (§6.1): an exact match, or else the only match by implicit conversions; from 4.00 on the best one.

use super::convert::Conversions;
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
    /// By conversions of these arguments, as bits.
    Converted(u32),
    None,
}

/// The rules of a language.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rules {
    pub(super) conversions: Conversions,
    /// Whether the best of several candidates is chosen, from 4.00 on.
    pub(super) best: bool,
}

/// Resolves a call among candidates, each given by its parameters.
pub(super) fn resolve<P>(
    types: &Types,
    rules: Rules,
    arguments: &[TypeId],
    candidates: impl Iterator<Item = P>,
) -> Resolution
where
    P: IntoIterator<Item = (TypeId, ParamMode)>,
{
    let mut found: Vec<(usize, u32)> = Vec::new();
    for (index, params) in candidates.enumerate() {
        match fit(types, rules.conversions, arguments, params) {
            Fit::Exact => return Resolution::Found(index),
            Fit::Converted(converted) => found.push((index, converted)),
            Fit::None => {}
        }
    }
    match found.as_slice() {
        [] => Resolution::Missing,
        [(only, _)] => Resolution::Found(*only),
        [(first, _), (second, _), ..] => {
            // Of two, that is better which converts fewer arguments and no other ones.
            let better = |one: u32, other: u32| one != other && one & !other == 0;
            let best = found
                .iter()
                .find(|(index, one)| found.iter().all(|(place, other)| place == index || better(*one, *other)));
            match best {
                Some((best, _)) if rules.best => Resolution::Found(*best),
                _ => Resolution::Ambiguous(*first, *second),
            }
        }
    }
}

/// How many of the first arguments a candidate takes, exactly or by conversions.
pub(super) fn leading(
    types: &Types,
    conversions: Conversions,
    arguments: &[TypeId],
    params: impl IntoIterator<Item = (TypeId, ParamMode)>,
) -> usize {
    let takes = |(argument, param)| argument == param || conversions.convert(types, argument, param);
    arguments.iter().zip(params).take_while(|&(&argument, (param, _))| takes((argument, param))).count()
}

fn fit(
    types: &Types,
    conversions: Conversions,
    arguments: &[TypeId],
    params: impl IntoIterator<Item = (TypeId, ParamMode)>,
) -> Fit {
    let (mut best, mut place) = (Fit::Exact, 0);
    let mut arguments = arguments.iter();
    for (param, mode) in params {
        let Some(&argument) = arguments.next() else { return Fit::None };
        place += 1;
        if argument == param {
            continue;
        }
        let inward = conversions.convert(types, argument, param);
        let outward = conversions.convert(types, param, argument);
        let possible = match mode {
            ParamMode::In | ParamMode::ConstIn => inward,
            ParamMode::Out => outward,
            ParamMode::Inout => inward && outward,
        };
        if !possible {
            return Fit::None;
        }
        let earlier = if let Fit::Converted(earlier) = best { earlier } else { 0 };
        best = Fit::Converted(earlier | 1 << (place % 32));
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
        let conversions = Conversions { to_float: true, to_uint: false };
        let rules = Rules { conversions, best: false };
        let call = |arguments: [TypeId; 2]| resolve(&types, rules, &arguments, functions.iter().copied());
        assert_eq!(call([TypeId::VEC4, TypeId::VEC4]), Resolution::Found(0));
        assert_eq!(call([TypeId::VEC4, IVEC4]), Resolution::Found(1));
        assert_eq!(call([IVEC4, TypeId::VEC4]), Resolution::Ambiguous(0, 1));
        assert_eq!(call([IVEC4, IVEC4]), Resolution::Found(1));
        assert_eq!(call([TypeId::BOOL, TypeId::VEC4]), Resolution::Missing);
    }

    /// `max(int, uint)` of 4.00: one conversion is better than two.
    #[test]
    fn the_best_overload_converts_least() {
        let (types, input) = (Types::new(), ParamMode::In);
        let (int, uint) = (TypeId::INT, TypeId::vector(Scalar::Uint, 1));
        let functions = [int, uint, TypeId::FLOAT].map(|ty| [(ty, input), (ty, input)]);
        let conversions = Conversions { to_float: true, to_uint: true };
        let call = |best| resolve(&types, Rules { conversions, best }, &[int, uint], functions.iter().copied());
        assert_eq!(call(true), Resolution::Found(1));
        assert_eq!(call(false), Resolution::Ambiguous(1, 2));
    }
}
