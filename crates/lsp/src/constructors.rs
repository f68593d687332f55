//! The constructors of the types of the language, for people (GLSL 1.50 §5.4).
//!
//! *In:* the name of a type and a version. *Out:* the ways to make a value of it. *Not done here:* constructors of structs, which the
//! shader has.

use glisten_front::language::{Feature, Version};

/// The components of vectors, and the columns of matrices.
const COMPONENTS: [&str; 4] = ["x", "y", "z", "w"];
/// Scalars with the first letter of their vectors, and how a vector of them is described.
static SCALARS: &[(&str, &str)] = &[("float", ""), ("int", "i"), ("uint", "u"), ("bool", "b")];

/// A constructor.
pub(crate) struct Constructor {
    /// The types and names of its parameters.
    pub(crate) params: Vec<String>,
    /// The value that it makes of them.
    pub(crate) sentence: &'static str,
}

impl Constructor {
    fn new(params: impl IntoIterator<Item = String>, sentence: &'static str) -> Self {
        Self { params: params.into_iter().collect(), sentence }
    }
}

/// A type of the language.
enum Shape {
    Scalar(&'static str),
    Vector(&'static str, &'static str, usize),
    Matrix(usize, usize),
}

fn shape(name: &str) -> Option<Shape> {
    if let Some((scalar, _)) = SCALARS.iter().find(|row| row.0 == name) {
        return Some(Shape::Scalar(scalar));
    }
    let size = |text: &str| text.parse().ok().filter(|size| (2..=4).contains(size));
    if let Some((columns, rows)) = name.strip_prefix("mat").map(|text| text.split_once('x').unwrap_or((text, text))) {
        return Some(Shape::Matrix(size(columns)?, size(rows)?));
    }
    let (letter, text) = name.split_once("vec")?;
    let (scalar, letter) = SCALARS.iter().find(|row| row.1 == letter)?;
    Some(Shape::Vector(scalar, letter, size(text)?))
}

/// The constructors of a type of the language, the one that is used most first.
pub(crate) fn constructors(name: &str, version: Version) -> Vec<Constructor> {
    match shape(name) {
        Some(Shape::Scalar(own)) => scalar(own, version),
        Some(Shape::Vector(scalar, letter, size)) => vector(scalar, letter, size, version),
        Some(Shape::Matrix(columns, rows)) => matrix(columns, rows, version),
        None => Vec::new(),
    }
}

/// The scalars that a version has, but for one.
fn others(own: &str, version: Version) -> impl Iterator<Item = &'static (&'static str, &'static str)> {
    let has = move |scalar: &str| scalar != "uint" || version.has(Feature::UnsignedLiterals);
    let own = own.to_owned();
    SCALARS.iter().filter(move |(scalar, _)| *scalar != own && has(scalar))
}

fn scalar(own: &'static str, version: Version) -> Vec<Constructor> {
    let mut rows: Vec<Constructor> = others(own, version)
        .map(|(other, _)| Constructor::new([format!("{other} value")], "Converts the value."))
        .collect();
    let letter = SCALARS.iter().find(|row| row.0 == own).map_or("", |row| row.1);
    rows.push(Constructor::new([format!("{letter}vec4 value")], "Takes the first component."));
    rows
}

fn vector(scalar: &str, letter: &str, size: usize, version: Version) -> Vec<Constructor> {
    let part = |start: usize, length: usize| {
        let names = COMPONENTS.get(start..start + length).unwrap_or(&[]).concat();
        if length == 1 { format!("{scalar} {names}") } else { format!("{letter}vec{length} {names}") }
    };
    let each = "Takes the components in order.";
    let mut rows = vec![Constructor::new((0..size).map(|at| part(at, 1)), each)];
    rows.push(Constructor::new([format!("{scalar} value")], "All components are the value."));
    let mut splits = splits(size);
    splits.retain(|lengths| lengths.len() > 1 && lengths.len() < size);
    for lengths in splits {
        let starts = lengths.iter().scan(0, |at, length| Some(std::mem::replace(at, *at + length)));
        rows.push(Constructor::new(starts.zip(&lengths).map(|(start, length)| part(start, *length)), each));
    }
    for (_, other) in others(scalar, version) {
        rows.push(Constructor::new([format!("{other}vec{size} value")], "Converts each component."));
    }
    for larger in size + 1..=4 {
        rows.push(Constructor::new([format!("{letter}vec{larger} value")], "Takes the first components."));
    }
    rows
}

/// The ways to put a number together of others, in order.
fn splits(size: usize) -> Vec<Vec<usize>> {
    if size == 0 {
        return vec![Vec::new()];
    }
    let with = |first: usize| splits(size - first).into_iter().map(move |rest| [vec![first], rest].concat());
    (1..=size).flat_map(with).collect()
}

fn matrix(columns: usize, rows: usize, version: Version) -> Vec<Constructor> {
    let vectors = (0..columns).map(|column| format!("vec{rows} column{column}"));
    let mut all = vec![Constructor::new(vectors, "Takes the columns in order.")];
    all.push(Constructor::new(["float value".to_owned()], "The diagonal is the value, the rest is zero."));
    let cells = (0..columns).flat_map(|column| (0..rows).map(move |row| format!("float m{column}{row}")));
    all.push(Constructor::new(cells, "Takes the elements, column by column."));
    if version.has(Feature::MatrixFromMatrix) {
        let from = if (columns, rows) == (4, 4) { "mat3 value" } else { "mat4 value" };
        all.push(Constructor::new(
            [from.to_owned()],
            "Takes the elements that both have; the others are those of the identity.",
        ));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::constructors;
    use glisten_front::language::{Profile, Version};
    use glisten_front::source::Span;

    fn labels(name: &str, version: u16) -> Vec<String> {
        let version = Version { number: version, profile: Profile::Core, span: Span::default() };
        constructors(name, version).iter().map(|row| row.params.join(", ")).collect()
    }

    #[test]
    fn all_ways_are_there() {
        let all = labels("vec3", 150);
        assert_eq!(all.first().map(String::as_str), Some("float x, float y, float z"));
        for row in ["float value", "vec2 xy, float z", "float x, vec2 yz", "ivec3 value", "uvec3 value", "vec4 value"] {
            assert!(all.iter().any(|one| one == row), "{row}: {all:?}");
        }
        assert!(labels("vec4", 150).contains(&"float x, vec2 yz, float w".to_owned()));
        assert!(!labels("vec3", 110).contains(&"uvec3 value".to_owned()), "1.10 has no unsigned integers");
        assert_eq!(labels("mat2x3", 150).first().map(String::as_str), Some("vec3 column0, vec3 column1"));
        assert!(labels("float", 150).contains(&"uint value".to_owned()));
        for name in ["vec5", "matx", "sampler2D", "foo", "vecs"] {
            assert!(labels(name, 150).is_empty(), "{name}");
        }
    }
}
