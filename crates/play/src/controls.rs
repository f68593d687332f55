//! The controls of a scene: its numbers, with their places in the text, which a slider rewrites.
//!
//! *In:* the text of a scene file. *Out:* a control for every number, switch, short vector and color of the camera, the material,
//! the lights and the uniforms. *Holds:* places count UTF-16 code units, as JavaScript's strings do; putting a value in its
//! place changes nothing else of the text.

use serde::Serialize;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The most controls of a scene: more than that, nobody looks through.
const MAX_CONTROLS: usize = 400;
/// The longest vector that has a control.
const MAX_COMPONENTS: usize = 4;
/// The tables whose numbers have no controls.
const WITHOUT: [&str; 8] = [
    "attribute_locations",
    "attributes",
    "frag_data_locations",
    "framebuffer",
    "gallery",
    "specialize",
    "stability",
    "textures",
];
/// Parts of the names of colors.
const COLORS: [&str; 9] =
    ["color", "colour", "ambient", "diffuse", "specular", "emission", "emissive", "tint", "albedo"];

/// The kind of a control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A switch.
    Bool,
    /// A number without a fraction.
    Integer,
    /// A number, or several.
    Number,
    /// Red, green and blue in [0, 1], and alpha after them if there are four.
    Color,
}

/// A control.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Control {
    /// The names of the tables and of the key: `camera`, `eye`.
    pub path: Vec<String>,
    /// The kind.
    pub kind: Kind,
    /// The numbers; 0 and 1 for a switch.
    pub values: Vec<f64>,
    /// The place of each number in the text.
    pub places: Vec<[usize; 2]>,
    /// The ends of the sliders.
    pub range: [f64; 2],
}

/// The controls of a scene's text; none if it is not TOML.
pub fn controls(text: &str) -> Vec<Control> {
    let Ok(table) = DeTable::parse(text) else { return Vec::new() };
    let mut found = Found { units: Units::new(text), path: Vec::new(), controls: Vec::new() };
    found.table(table.get_ref());
    found.controls.sort_by_key(|control| control.places.first().map(|place| place[0]));
    found.controls.truncate(MAX_CONTROLS);
    found.controls
}

/// The numbers of UTF-16 code units before places in a text.
struct Units {
    /// For each byte, how many fewer units than bytes lie before it; empty for a text of ASCII.
    fewer: Vec<u32>,
}

impl Units {
    fn new(text: &str) -> Self {
        if text.is_ascii() {
            return Self { fewer: Vec::new() };
        }
        let mut fewer = Vec::with_capacity(text.len() + 1);
        let mut before = 0;
        for character in text.chars() {
            fewer.extend(std::iter::repeat_n(before, character.len_utf8()));
            before += (character.len_utf8() - character.len_utf16()) as u32;
        }
        fewer.push(before);
        Self { fewer }
    }

    fn at(&self, byte: usize) -> usize {
        byte - self.fewer.get(byte).map_or(0, |fewer| *fewer as usize)
    }

    fn place(&self, span: &Range<usize>) -> [usize; 2] {
        [self.at(span.start), self.at(span.end)]
    }
}

struct Found {
    units: Units,
    path: Vec<String>,
    controls: Vec<Control>,
}

impl Found {
    fn table(&mut self, table: &DeTable<'_>) {
        for (key, value) in table {
            let key = key.get_ref().as_ref();
            if WITHOUT.contains(&key) {
                continue;
            }
            self.path.push(key.to_owned());
            self.value(value);
            self.path.pop();
        }
    }

    fn value(&mut self, value: &Spanned<DeValue<'_>>) {
        match value.get_ref() {
            DeValue::Table(table) => self.table(table),
            DeValue::Array(array) => {
                let numbers: Option<Vec<_>> = array.iter().map(number).collect();
                match numbers {
                    Some(numbers) if (1..=MAX_COMPONENTS).contains(&numbers.len()) => self.add(&numbers),
                    Some(_) => {}
                    None => {
                        for (index, element) in array.iter().enumerate() {
                            self.path.push(index.to_string());
                            self.value(element);
                            self.path.pop();
                        }
                    }
                }
            }
            // The numbers of a draw itself are how many vertices there are, and what the pipeline does.
            _ if self.path.first().is_some_and(|first| first == "draw") && self.path.len() <= 3 => {}
            _ => self.add(&number(value).into_iter().collect::<Vec<_>>()),
        }
    }

    fn add(&mut self, numbers: &[Number]) {
        let Some(first) = numbers.first() else { return };
        // Vectors may mix `1` and `0.5`.
        let kind = if numbers.iter().all(|number| number.kind == first.kind) { first.kind } else { Kind::Number };
        let values: Vec<f64> = numbers.iter().map(|number| number.value).collect();
        let name = self.path.last().map(|name| name.to_ascii_lowercase()).unwrap_or_default();
        let is_color = values.len() >= 3
            && kind != Kind::Bool
            && COLORS.iter().any(|color| name.contains(color))
            && values.iter().all(|value| (0.0..=1.0).contains(value));
        self.controls.push(Control {
            path: self.path.clone(),
            kind: if is_color { Kind::Color } else { kind },
            places: numbers.iter().map(|number| self.units.place(&number.span)).collect(),
            range: range(&values, kind),
            values,
        });
    }
}

struct Number {
    kind: Kind,
    value: f64,
    span: Range<usize>,
}

fn number(value: &Spanned<DeValue<'_>>) -> Option<Number> {
    let (kind, number) = match value.get_ref() {
        DeValue::Boolean(is_on) => (Kind::Bool, f64::from(u8::from(*is_on))),
        DeValue::Integer(integer) if integer.radix() == 10 => (Kind::Integer, integer.as_str().parse().ok()?),
        DeValue::Float(float) => (Kind::Number, float.as_str().parse().ok()?),
        _ => return None,
    };
    number.is_finite().then(|| Number { kind, value: number, span: value.span() })
}

/// The ends of a slider for some values: room to double them, and both signs for vectors.
fn range(values: &[f64], kind: Kind) -> [f64; 2] {
    let most = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let has_both = values.len() > 1 || values.iter().any(|value| *value < 0.0);
    let end = match kind {
        Kind::Bool => return [0.0, 1.0],
        Kind::Integer => (2.0 * most).max(4.0),
        _ if most <= 1.0 => 1.0,
        _ => 2.0 * most,
    };
    [if has_both { -end } else { 0.0 }, end]
}

#[cfg(test)]
mod tests {
    use super::{Control, Kind, controls};

    const SCENE: &str = r#"
# für die Übung 🎨
[framebuffer]
width = 64
[camera]
eye = [0, 1.5, -6]
fovy = 30
[material]
diffuse = [0.5, 0.25, 1]
shininess = 32.0
[[light]]
kind = "point"
color = [2.0, 1.0, 1.0]
[[light]]
is_on = true
[[draw]]
vertex = "a.vert"
vertex_count = 6
[draw.attributes]
position = { size = 2, values = [0, 1] }
[draw.uniforms]
mode = 2
matrix = [1, 0, 0, 0, 1, 0, 0, 0, 1]
mask = 0xff
"#;

    fn by_name<'a>(all: &'a [Control], name: &str) -> Option<&'a Control> {
        all.iter().find(|control| control.path.join(".") == name)
    }

    #[test]
    fn numbers_have_controls_at_their_places() {
        let all = controls(SCENE);
        let names: Vec<String> = all.iter().map(|control| control.path.join(".")).collect();
        let expected = [
            "camera.eye",
            "camera.fovy",
            "material.diffuse",
            "material.shininess",
            "light.0.color",
            "light.1.is_on",
            "draw.0.uniforms.mode",
        ];
        assert_eq!(names, expected);
        let units: Vec<u16> = SCENE.encode_utf16().collect();
        let at = |name: &str| -> Vec<String> {
            let places = &by_name(&all, name).expect("it is there").places;
            places.iter().map(|place| String::from_utf16_lossy(&units[place[0]..place[1]])).collect()
        };
        assert_eq!(at("camera.eye"), ["0", "1.5", "-6"]);
        assert_eq!(at("light.1.is_on"), ["true"]);
        assert_eq!(at("material.shininess"), ["32.0"]);
    }

    #[test]
    fn kinds_and_ranges_suit_the_values() {
        let all = controls(SCENE);
        let of = |name: &str| by_name(&all, name).map(|control| (control.kind, control.range)).expect("it is there");
        assert_eq!(of("material.diffuse").0, Kind::Color);
        assert_eq!(of("light.0.color"), (Kind::Number, [-4.0, 4.0]), "beyond 1 it is no color of the screen");
        assert_eq!(of("camera.eye"), (Kind::Number, [-12.0, 12.0]));
        assert_eq!(of("draw.0.uniforms.mode"), (Kind::Integer, [0.0, 4.0]));
        assert_eq!(of("material.shininess"), (Kind::Number, [0.0, 64.0]));
    }

    #[test]
    fn what_is_not_toml_has_none() {
        assert!(controls("a = [").is_empty() && controls("").is_empty());
    }
}
