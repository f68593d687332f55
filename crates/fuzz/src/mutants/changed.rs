//! The changes: a table, and what each does to the pieces of a text.

use super::Chance;
use super::tokens::{Kind, pieces};

/// A changed source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mutant {
    /// The text.
    pub text: String,
    /// The first line that differs, from 1.
    pub line: usize,
    /// The kind of change, in words.
    pub change: &'static str,
}

const TYPES: &[&str] = &[
    "float",
    "int",
    "uint",
    "bool",
    "vec2",
    "vec3",
    "vec4",
    "ivec2",
    "ivec3",
    "uvec2",
    "bvec3",
    "mat2",
    "mat3",
    "mat4",
    "mat2x3",
    "sampler2D",
    "samplerCube",
    "sampler2DShadow",
    "isampler2D",
    "void",
];
const QUALIFIERS: &[&str] = &[
    "in",
    "out",
    "uniform",
    "const",
    "flat",
    "smooth",
    "noperspective",
    "centroid",
    "inout",
    "invariant",
    "varying",
    "attribute",
    "highp",
    "precise",
];
const SIGNS: &[&str] = &[
    "+", "-", "*", "/", "%", "<", ">", "<=", ">=", "==", "!=", "&&", "||", "^^", "&", "|", "^", "<<", ">>", "=", "+=",
    "-=", "*=", "!", "~", "?", ":", ",", ";", ".", "(", ")", "{", "}", "[", "]", "++",
];
const NUMBERS: &[&str] = &[
    "0",
    "1",
    "2",
    "3",
    "1.0",
    "0.5",
    "2u",
    "true",
    "false",
    "1e40",
    "07",
    "08",
    "0x",
    "1.0f",
    "3.0lf",
    "-1",
    "99999999999",
    ".5",
];
const FUNCTIONS: &[&str] = &[
    "sin",
    "dot",
    "cross",
    "normalize",
    "texture",
    "textureLod",
    "texelFetch",
    "mix",
    "clamp",
    "dFdx",
    "inverse",
    "transpose",
    "length",
    "pow",
    "mod",
    "abs",
    "max",
    "vec3",
    "vec4",
    "mat3",
    "float",
    "int",
    "lessThan",
    "any",
    "not",
    "isnan",
    "modf",
    "fwidth",
    "ftransform",
    "texture2D",
    "textureSize",
    "EmitVertex",
    "reflect",
    "smoothstep",
];
const SWIZZLES: &[&str] = &["x", "xy", "xyz", "rgb", "xyzw", "rg", "stp", "w", "xr", "zzzz", "q", "xyzwx", "length"];

/// Something that is done to a list of pieces. It returns false where nothing fits.
type Change = fn(&mut Pieces<'_>, &mut Chance) -> bool;

/// All changes, each as likely as the others.
static CHANGES: &[(&str, Change)] = &[
    ("a token is left out", |pieces, chance| pieces.replace(chance, |_| true, |_, _| Some(String::new()))),
    ("a token stands twice", |pieces, chance| pieces.replace(chance, |_| true, |old, _| Some(format!("{old} {old}")))),
    ("two tokens are exchanged", |pieces, chance| pieces.exchange(chance)),
    ("another name", |pieces, chance| {
        let names = pieces.texts(|piece| piece.0 == Kind::Word);
        pieces.replace(chance, |piece| piece.0 == Kind::Word, |_, chance| chance.one(&names).cloned())
    }),
    ("another number", |pieces, chance| pieces.replace(chance, |piece| piece.0 == Kind::Number, of(NUMBERS))),
    ("another type", |pieces, chance| pieces.replace(chance, |piece| TYPES.contains(&piece.1.as_str()), of(TYPES))),
    ("a qualifier too many", |pieces, chance| {
        let before = |old: &str, chance: &mut Chance| Some(format!("{} {old}", chance.one(QUALIFIERS)?));
        pieces.replace(chance, |piece| TYPES.contains(&piece.1.as_str()), before)
    }),
    ("another qualifier", |pieces, chance| {
        pieces.replace(chance, |piece| QUALIFIERS.contains(&piece.1.as_str()), of(QUALIFIERS))
    }),
    ("another sign", |pieces, chance| pieces.replace(chance, |piece| piece.0 == Kind::Sign, of(SIGNS))),
    ("another function", |pieces, chance| pieces.replace_beside(chance, Side::Before, "(", FUNCTIONS)),
    ("another swizzle", |pieces, chance| pieces.replace_beside(chance, Side::Behind, ".", SWIZZLES)),
    ("parentheses around a token", |pieces, chance| {
        pieces.replace(chance, |_| true, |old, _| Some(format!("({old})")))
    }),
    ("braces around a token", |pieces, chance| pieces.replace(chance, |_| true, |old, _| Some(format!("{{{old}}}")))),
    ("a line is left out", |pieces, chance| pieces.in_lines(chance, |lines, at, _| lines.remove(at).is_empty())),
    ("two lines are exchanged", |pieces, chance| {
        pieces.in_lines(chance, |lines, at, other| {
            lines.swap(at, other);
            at == other
        })
    }),
];

/// One of a list.
fn of(list: &'static [&'static str]) -> impl Fn(&str, &mut Chance) -> Option<String> {
    move |_, chance| chance.one(list).map(|one| (*one).to_owned())
}

/// A changed text; none if the change that chance takes fits nowhere, or changes nothing.
pub fn mutant(text: &str, chance: &mut Chance) -> Option<Mutant> {
    let (change, apply) = chance.one(CHANGES)?;
    let mut list =
        Pieces { list: pieces(text).into_iter().map(|(kind, piece)| (kind, piece.to_owned())).collect(), whole: text };
    if !apply(&mut list, chance) {
        return None;
    }
    let changed: String = list.list.into_iter().map(|piece| piece.1).collect();
    let same = changed.lines().zip(text.lines()).take_while(|(new, old)| new == old).count();
    (changed != text).then_some(Mutant { text: changed, line: same + 1, change })
}

struct Pieces<'a> {
    list: Vec<(Kind, String)>,
    whole: &'a str,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Before,
    Behind,
}

impl Pieces<'_> {
    /// The places of the pieces that may be changed.
    fn places(&self) -> Vec<usize> {
        (0..self.list.len())
            .filter(|place| self.list.get(*place).is_some_and(|piece| piece.0 != Kind::Between))
            .collect()
    }

    fn texts(&self, is_meant: impl Fn(&(Kind, String)) -> bool) -> Vec<String> {
        self.list.iter().filter(|piece| is_meant(piece)).map(|piece| piece.1.clone()).collect()
    }

    /// Replaces one of the pieces that are meant.
    fn replace(
        &mut self,
        chance: &mut Chance,
        is_meant: impl Fn(&(Kind, String)) -> bool,
        by: impl Fn(&str, &mut Chance) -> Option<String>,
    ) -> bool {
        let meant: Vec<usize> =
            self.places().into_iter().filter(|place| self.list.get(*place).is_some_and(&is_meant)).collect();
        let Some(piece) = chance.one(&meant).and_then(|place| self.list.get_mut(*place)) else { return false };
        let Some(new) = by(&piece.1, chance) else { return false };
        piece.1 = new;
        true
    }

    /// Replaces a word next to a sign.
    fn replace_beside(&mut self, chance: &mut Chance, side: Side, sign: &str, by: &[&str]) -> bool {
        let places = self.places();
        let at = |place: &usize| self.list.get(*place);
        let fits = |pair: &[usize]| -> Option<usize> {
            let (first, second) = (pair.first()?, pair.get(1)?);
            let (word, other) = if side == Side::Before { (first, second) } else { (second, first) };
            (at(word)?.0 == Kind::Word && at(other)?.1 == sign).then_some(*word)
        };
        let meant: Vec<usize> = places.windows(2).filter_map(fits).collect();
        let (place, new) = (chance.one(&meant).copied(), chance.one(by));
        let Some((piece, new)) = place.and_then(|place| self.list.get_mut(place)).zip(new) else { return false };
        piece.1 = (*new).to_owned();
        true
    }

    /// Exchanges a piece and the next one.
    fn exchange(&mut self, chance: &mut Chance) -> bool {
        let places = self.places();
        let pairs: Vec<&[usize]> = places.windows(2).collect();
        let Some([first, second]) = chance.one(&pairs) else { return false };
        self.list.swap(*first, *second);
        true
    }

    /// Changes the lines that are neither empty nor directives; `change` gets two of them, and says whether nothing changed.
    fn in_lines(&mut self, chance: &mut Chance, change: impl Fn(&mut Vec<&str>, usize, usize) -> bool) -> bool {
        let mut lines: Vec<&str> = self.whole.split('\n').collect();
        let is_code = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with(['#', '/']);
        let code: Vec<usize> =
            lines.iter().enumerate().filter(|(_, line)| is_code(line)).map(|(number, _)| number).collect();
        let (Some(at), Some(other)) = (chance.one(&code).copied(), chance.one(&code).copied()) else { return false };
        if change(&mut lines, at, other) {
            return false;
        }
        self.list = vec![(Kind::Between, lines.join("\n"))];
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::Chance;
    use super::{CHANGES, mutant};
    use std::collections::BTreeSet;

    const TEXT: &str = "#version 150\nuniform sampler2D t;\nin vec2 uv;\nout vec4 c;\nvoid main() {\n    c = texture(t, uv).xyzw * 2.0;\n}\n";

    #[test]
    fn each_change_occurs_and_names_its_line() {
        let mut chance = Chance::new(7);
        let mut seen = BTreeSet::new();
        for _ in 0..2000 {
            let Some(mutant) = mutant(TEXT, &mut chance) else { continue };
            assert_ne!(mutant.text, TEXT);
            assert!(mutant.text.starts_with("#version 150\n") && mutant.line >= 2, "{mutant:?}");
            seen.insert(mutant.change);
        }
        assert_eq!(seen.len(), CHANGES.len(), "{seen:?}");
    }

    #[test]
    fn chance_is_the_same_everywhere() {
        let made = |seed| (0..20).map(|_| mutant(TEXT, &mut Chance::new(seed))).collect::<Vec<_>>();
        assert_eq!(made(3), made(3));
        let mut chance = Chance::new(1);
        let numbers: Vec<usize> = (0..4).map(|_| chance.below(1000)).collect();
        assert_eq!(numbers, [465, 519, 590, 235]);
    }
}
