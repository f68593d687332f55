//! Component names of vectors (§5.5), parsed into swizzles.

use crate::hir::Swizzle;

/// The three sets of names, which cannot be mixed.
const SETS: [&str; 3] = ["xyzw", "rgba", "stpq"];

/// Why a field of a vector is not a swizzle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    /// A letter that names no component.
    NoComponent(char),
    /// Letters of two sets.
    Mixed,
    /// More than four letters.
    TooLong,
    /// A component that the vector does not have.
    Missing(char),
}

/// Parses the swizzle of a vector of `size` components.
pub(super) fn parse(text: &str, size: u8) -> Result<Swizzle, Fault> {
    let mut swizzle = Swizzle { len: 0, components: [0; 4] };
    let mut set = None;
    for letter in text.chars() {
        let found = SETS.iter().enumerate().find_map(|(index, names)| Some((index, names.find(letter)?)));
        let (its_set, component) = found.ok_or(Fault::NoComponent(letter))?;
        if *set.get_or_insert(its_set) != its_set {
            return Err(Fault::Mixed);
        }
        if component >= usize::from(size) {
            return Err(Fault::Missing(letter));
        }
        let slot = swizzle.components.get_mut(usize::from(swizzle.len)).ok_or(Fault::TooLong)?;
        *slot = component as u8;
        swizzle.len += 1;
    }
    Ok(swizzle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_set_names_the_same_components() {
        for text in ["wzyx", "abgr", "qpts"] {
            assert_eq!(parse(text, 4), Ok(Swizzle { len: 4, components: [3, 2, 1, 0] }));
        }
    }

    #[test]
    fn faults_are_told_apart() {
        assert_eq!(parse("xg", 4), Err(Fault::Mixed));
        assert_eq!(parse("z", 2), Err(Fault::Missing('z')));
        assert_eq!(parse("xxxxx", 4), Err(Fault::TooLong));
        assert_eq!(parse("length", 4), Err(Fault::NoComponent('l')));
    }
}
