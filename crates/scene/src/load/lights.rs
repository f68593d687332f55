//! `[[light]]` and `global_ambient`: the values for uniforms of the library's module `scene`.
//!
//! *In:* the scene's tables. *Out:* [`Lighting`], and for a draw the value of each member of its lights by name.
//! *Holds:* positions and directions are computed in f64, in world space or in the draw's eye space, and rounded
//! once. Directions keep the length given in the scene.

mod shapes;

use self::shapes::Shape;
use super::paste;
use crate::fixed::LightSource;
use crate::tables::{Node, Reader};
use glam::{DMat4, DVec3};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::SCENE_MISSING_KEY;
use glisten_front::source::Span;
use toml::de::DeTable;

/// The kinds of lights, with the numbers of the module's constants `LIGHT_DIRECTIONAL` and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Directional,
    Point,
    Spot,
    Hemisphere,
    Sphere = 5,
    Tube,
    Disk,
    Rectangle,
}

const KINDS: &[(&str, Kind)] = &[
    ("directional", Kind::Directional),
    ("point", Kind::Point),
    ("spot", Kind::Spot),
    ("hemisphere", Kind::Hemisphere),
    ("sphere", Kind::Sphere),
    ("tube", Kind::Tube),
    ("disk", Kind::Disk),
    ("rectangle", Kind::Rectangle),
];

impl Kind {
    /// A light of this kind, in messages.
    fn place(self) -> &'static str {
        match self {
            Self::Directional => "a directional light",
            Self::Point => "a point light",
            Self::Spot => "a spot light",
            Self::Hemisphere => "a hemisphere light",
            Self::Sphere => "a sphere light",
            Self::Tube => "a tube light",
            Self::Disk => "a disk light",
            Self::Rectangle => "a rectangle light",
        }
    }

    /// The keys of its table.
    fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Directional => &["kind", "towards", "color", "ambient", "diffuse", "specular"],
            Self::Point => &["kind", "position", "color", "ambient", "diffuse", "specular", "attenuation", "range"],
            Self::Spot => &[
                "kind",
                "position",
                "direction",
                "target",
                "exponent",
                "color",
                "ambient",
                "diffuse",
                "specular",
                "attenuation",
                "range",
                "cone",
            ],
            Self::Hemisphere => &["kind", "axis", "sky", "ground"],
            Self::Sphere => &["kind", "position", "radius", "color", "diffuse", "specular"],
            Self::Tube => &["kind", "from", "to", "radius", "color", "diffuse", "specular"],
            Self::Disk => {
                &["kind", "position", "direction", "target", "radius", "two_sided", "color", "diffuse", "specular"]
            }
            Self::Rectangle => &[
                "kind",
                "position",
                "direction",
                "target",
                "up",
                "width",
                "height",
                "two_sided",
                "color",
                "diffuse",
                "specular",
            ],
        }
    }

    /// Keys without which it has no position or direction, each with a value to begin with.
    fn required(self, table: &DeTable<'_>) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Directional => &[("towards", "[0.5, 0.7, 0.6]")],
            Self::Point => &[("position", "[1.0, 2.0, 2.0]")],
            Self::Sphere => &[("position", "[1.0, 2.0, 2.0]"), ("radius", "0.5")],
            Self::Tube => &[("from", "[-1.0, 2.0, 0.0]"), ("to", "[1.0, 2.0, 0.0]"), ("radius", "0.05")],
            Self::Disk if table.contains_key("target") => &[("position", "[0.0, 3.0, 2.0]"), ("radius", "0.5")],
            Self::Disk => &[("position", "[0.0, 3.0, 2.0]"), ("direction", "[0.0, -3.0, -2.0]"), ("radius", "0.5")],
            Self::Rectangle if table.contains_key("target") => {
                &[("position", "[0.0, 3.0, 2.0]"), ("width", "2.0"), ("height", "1.0")]
            }
            Self::Rectangle => &[
                ("position", "[0.0, 3.0, 2.0]"),
                ("direction", "[0.0, -3.0, -2.0]"),
                ("width", "2.0"),
                ("height", "1.0"),
            ],
            Self::Spot if table.contains_key("target") => &[("position", "[0.0, 3.0, 2.0]")],
            Self::Spot => &[("position", "[0.0, 3.0, 2.0]"), ("direction", "[0.0, -3.0, -2.0]")],
            Self::Hemisphere => &[],
        }
    }

    /// Whether a light of this kind has a shape, which the program `standard` has with the macro `GLISTEN_AREAS`.
    fn has_shape(self) -> bool {
        matches!(self, Self::Sphere | Self::Tube | Self::Disk | Self::Rectangle)
    }
}

/// The space of positions and directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LightSpace {
    World,
    /// Eye space: the camera is at the origin and looks down -z.
    Eye,
}

pub(super) const LIGHT_SPACES: &[(&str, LightSpace)] = &[("world", LightSpace::World), ("eye", LightSpace::Eye)];

/// A value for a member of a uniform struct.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Member {
    Int(i32),
    Float(f64),
    Pair([f64; 2]),
    Vector([f64; 3]),
}

/// All lights of a scene.
#[derive(Clone, Debug, Default)]
pub(super) struct Lighting {
    pub(super) lights: Vec<Light>,
    /// Ambient light that belongs to no light source: L_glob of (100).
    pub(super) global_ambient: [f64; 3],
    /// How many of the lights are the scene's own, and not those of files.
    n_own: usize,
}

/// The lights that programs of the library have room for by themselves.
const ROOM: usize = 8;

/// One light.
#[derive(Clone, Debug)]
pub(super) struct Light {
    /// The span of its table.
    pub(super) span: Span,
    kind: Kind,
    position: DVec3,
    direction: DVec3,
    ambient: [f64; 3],
    diffuse: [f64; 3],
    specular: [f64; 3],
    attenuation: [f64; 3],
    exponent: f64,
    /// Where the inverse square law ends, instead of `attenuation`.
    range: Option<f64>,
    /// The inner and the outer angle of a spot's cone in degrees, instead of `exponent`.
    cone: Option<[f64; 2]>,
    shape: Shape,
}

impl Lighting {
    /// The lights of a scene.
    pub(super) fn load(reader: &mut Reader, table: &DeTable<'_>) -> Self {
        let mut lights = Vec::new();
        if let Some(node) = table.get("light") {
            match node.get_ref().as_array() {
                Some(array) => lights.extend(array.iter().filter_map(|node| Light::load(reader, node))),
                None => reader.wrong_type(node, "light", "a list of tables, each headed `[[light]]`"),
            }
        }
        let n_own = lights.len();
        Self { lights, global_ambient: reader.reals(table, "global_ambient", [0.0; 3]), n_own }
    }

    /// The room that the lights of files need beyond what programs have. A scene says itself how many lights of its own there may be.
    pub(super) fn room(&self) -> Option<usize> {
        let n_lights = self.lights.len();
        (n_lights > ROOM && self.n_own <= ROOM && n_lights > self.n_own).then_some(n_lights)
    }

    /// Whether a light has a range or a cone, which the library's programs have with the macro `GLISTEN_CONES`.
    pub(super) fn has_cones(&self) -> bool {
        self.lights.iter().any(|light| light.range.is_some() || light.cone.is_some())
    }

    /// Whether a light has a shape.
    pub(super) fn has_areas(&self) -> bool {
        self.lights.iter().any(|light| light.kind.has_shape())
    }
}

impl Light {
    pub(super) fn load(reader: &mut Reader, node: &Node<'_>) -> Option<Self> {
        let table = reader.table(node, "light")?;
        let span = reader.span_of(node);
        let Some(kind) = table.get("kind") else {
            let all = KINDS.iter().flat_map(|(_, kind)| kind.keys()).copied().collect::<Vec<_>>();
            reader.check_keys(table, "a light", &all);
            if reader.is_misspelled(table, "kind") {
                return None;
            }
            let help =
                "add `kind = \"directional\"`, or `point`, `spot`, `hemisphere`, `sphere`, `tube`, `disk`, `rectangle`";
            reader.report(Diagnostic::new(&SCENE_MISSING_KEY, span, "a light names its kind").help(help));
            return None;
        };
        let kind = reader.choice(kind, "kind", KINDS)?;
        let (place, keys) = (kind.place(), kind.keys());
        reader.check_keys(table, place, keys);
        require(reader, table, span, place, kind)?;
        let shape = Shape::load(reader, table, kind)?;
        let position = match kind {
            Kind::Tube => shapes::middle(reader, table),
            _ => DVec3::from(reader.reals(table, "position", [0.0; 3])),
        };
        let direction = match kind {
            // In the struct, the direction is that of the light's travel.
            Kind::Directional => -DVec3::from(reader.reals(table, "towards", [0.0, 1.0, 0.0])),
            Kind::Spot if table.contains_key("target") => {
                DVec3::from(reader.reals(table, "target", [0.0; 3])) - position
            }
            Kind::Spot => reader.reals(table, "direction", [0.0, -1.0, 0.0]).into(),
            Kind::Hemisphere => reader.reals(table, "axis", [0.0, 1.0, 0.0]).into(),
            Kind::Disk | Kind::Rectangle => shape.direction,
            Kind::Point | Kind::Sphere | Kind::Tube => DVec3::ZERO,
        };
        let color = reader.reals(table, "color", [1.0; 3]);
        let (below, above) = match kind {
            Kind::Hemisphere => ("ground", "sky"),
            _ => ("ambient", "diffuse"),
        };
        Some(Self {
            span,
            kind,
            position,
            direction,
            ambient: reader.reals(table, below, [0.0; 3]),
            diffuse: reader.reals(table, above, color),
            specular: reader.reals(table, "specular", color),
            attenuation: reader.reals(table, "attenuation", shape.attenuation(kind)),
            exponent: reader.real(table, "exponent", 1.0),
            range: load_range(reader, table),
            cone: load_cone(reader, table),
            shape,
        })
    }

    /// The light as a source of OpenGL, in eye space. Half spheres become ambient light of their mean color, and a beam
    /// has no edge, so that its cutoff is 90 degrees.
    pub(super) fn source(&self, view: DMat4) -> LightSource {
        let position = view.transform_point3(self.position).extend(1.0).to_array();
        let direction = view.transform_vector3(self.direction);
        let lit = LightSource {
            ambient: opaque(self.ambient),
            diffuse: opaque(self.diffuse),
            specular: opaque(self.specular),
            attenuation: self.attenuation,
            position,
            ..LightSource::initial(1)
        };
        match self.kind {
            Kind::Directional => LightSource { position: (-direction).extend(0.0).to_array(), ..lit },
            Kind::Point | Kind::Sphere | Kind::Tube | Kind::Disk | Kind::Rectangle => lit,
            Kind::Spot => LightSource {
                spot_direction: direction.normalize_or(DVec3::NEG_Z).to_array(),
                spot_exponent: self.exponent,
                spot_cutoff: self.cone.map_or(90.0, |[_, outer]| outer),
                ..lit
            },
            Kind::Hemisphere => {
                let (sky, ground) = (DVec3::from(self.diffuse), DVec3::from(self.ambient));
                LightSource { ambient: opaque(((sky + ground) / 2.0).to_array()), ..LightSource::initial(1) }
            }
        }
    }

    /// The members of the struct `Light`, by name.
    pub(super) fn members(&self, space: LightSpace, view: DMat4) -> [(&'static str, Member); 14] {
        let turned = |vector: DVec3| match space {
            LightSpace::World => vector,
            LightSpace::Eye => view.transform_vector3(vector),
        };
        let position = match space {
            LightSpace::World => self.position,
            LightSpace::Eye => view.transform_point3(self.position),
        };
        let [direction, x, y] = [self.direction, self.shape.x, self.shape.y].map(turned);
        [
            ("kind", Member::Int(self.kind as i32)),
            ("position", Member::Vector(position.to_array())),
            ("direction", Member::Vector(direction.to_array())),
            ("ambient", Member::Vector(self.ambient)),
            ("diffuse", Member::Vector(self.diffuse)),
            ("specular", Member::Vector(self.specular)),
            ("attenuation", Member::Vector(self.attenuation)),
            ("exponent", Member::Float(self.exponent)),
            ("range", Member::Float(self.range.unwrap_or(0.0))),
            ("inner", Member::Float(self.cone.map_or(0.0, |[inner, _]| one_minus_cos(inner)))),
            ("outer", Member::Float(self.cone.map_or(0.0, |[_, outer]| one_minus_cos(outer)))),
            ("x", Member::Vector(x.to_array())),
            ("y", Member::Vector(y.to_array())),
            ("radius", Member::Float(self.shape.radius)),
        ]
    }
}

/// 1 - cos of an angle in degrees, without the cancellation of narrow ones.
fn one_minus_cos(angle: f64) -> f64 {
    2.0 * (angle.to_radians() / 2.0).sin().powi(2)
}

/// `range`: a distance above 0; `None` for a light that does not end.
fn load_range(reader: &mut Reader, table: &DeTable<'_>) -> Option<f64> {
    let node = table.get("range")?;
    let range = reader.finite(node, "range")?;
    let span = reader.span_of(node);
    if range <= 0.0 {
        reader.wrong_value(span, "a light's `range` is above 0", "no distance");
        return None;
    }
    exclude(reader, table, "range", "attenuation");
    Some(range)
}

/// `cone`: the inner and the outer angle between the beam's middle and its edge.
fn load_cone(reader: &mut Reader, table: &DeTable<'_>) -> Option<[f64; 2]> {
    let node = table.get("cone")?;
    let cone = reader.reals(table, "cone", [0.0, 45.0]);
    let [inner, outer] = cone;
    let span = reader.span_of(node);
    if !(0.0 <= inner && inner < outer && outer <= 90.0) {
        let message = "a `cone` is an inner and a larger outer angle, 0 to 90 degrees";
        reader.wrong_value(span, message, "expected `[inner, outer]`");
        return None;
    }
    exclude(reader, table, "cone", "exponent");
    Some(cone)
}

/// Reports a key that another one replaces.
fn exclude(reader: &mut Reader, table: &DeTable<'_>, key: &str, other: &str) {
    if let Some((name, _)) = table.get_key_value(other) {
        let span = reader.span_of(name);
        reader.wrong_value(span, format!("a light with a `{key}` has no `{other}`"), "leave one of the two out");
    }
}

/// A color with alpha 1.
pub(super) fn opaque([r, g, b]: [f64; 3]) -> [f64; 4] {
    [r, g, b, 1.0]
}

/// Reports the missing keys without which a light of this kind has no position or direction.
fn require(reader: &mut Reader, table: &DeTable<'_>, span: Span, place: &str, kind: Kind) -> Option<()> {
    let missing: Vec<&(&str, &str)> =
        kind.required(table).iter().filter(|(key, _)| !table.contains_key(*key)).collect();
    if missing.is_empty() {
        return Some(());
    }
    let untold: Vec<&&(&str, &str)> = missing.iter().filter(|(key, _)| !reader.is_misspelled(table, key)).collect();
    if !untold.is_empty() {
        let names: Vec<&str> = untold.iter().map(|(key, _)| *key).collect();
        let lines: Vec<String> = untold.iter().map(|(key, value)| format!("{key} = {value}")).collect();
        let message = format!("{place} has no {}", paste::names(&names));
        let help = match lines.as_slice() {
            [line] => format!("add `{line}`"),
            _ => format!("add:\n{}", lines.join("\n")),
        };
        reader.report(Diagnostic::new(&SCENE_MISSING_KEY, span, message).here("in this light").help(help));
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The module's constants must be equal to the numbers in a scene.
    #[test]
    fn kinds_have_the_numbers_of_the_module() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shader_lib/lights.glsl");
        let text = std::fs::read_to_string(path).expect("the module is there");
        for (name, kind) in KINDS {
            let line = format!("const int LIGHT_{} = {};\n", name.to_uppercase(), *kind as i32);
            assert!(text.contains(&line), "{line}");
        }
    }
}
