//! [`Sample`]: the values of the symbols at a point of a surface.
//!
//! *In:* a draw and a point. *Out:* numbers and vectors by name. *Holds:* a symbol is what is printed next to the
//! picture, else what the documents say, else a number of the scene. The documents' own gate holds for all
//! highlights: there is none where the light does not reach (N.L <= 0), as the page says once for all.

use super::Used;
use super::facts::{matrix, uniform, vector};
use super::tex::{Definition, Node, Value, Values, definitions, dot, evaluate};
use glam::DVec3;
use glisten_verify::scene::{Draw, Texels};
use std::cell::Cell;
use std::sync::LazyLock;

/// The documents' meanings of symbols, for whatever a scene does not print.
const MEANINGS: &[&str] = &[
    r"\mathbf{R} = 2 (\mathbf{N} \cdot \mathbf{L}) \mathbf{N} - \mathbf{L}",
    r"\mathbf{H} = \frac{\mathbf{L} + \mathbf{V}}{|\mathbf{L} + \mathbf{V}|}",
    r"\cos\theta_r = \mathbf{R} \cdot \mathbf{V}",
    r"\cos\theta_h = \mathbf{N} \cdot \mathbf{H}",
    r"\cos\theta = \mathbf{N} \cdot \mathbf{A}",
    r"r = |\mathbf{P}_l - \mathbf{P}|",
    r"I_{amb} = K_{amb} \otimes L_{amb}",
    r"I_{diff} = \max(\mathbf{N} \cdot \mathbf{L}, 0) \, K_{diff} \otimes L_{diff}",
    r"C_{dome} = \frac{1 + \cos\theta}{2} C_{sky} + \frac{1 - \cos\theta}{2} C_{ground}",
    r"C_{diffuse} = \max(\mathbf{N} \cdot \mathbf{L}, 0) \, C_{mesh} + C_{amb} \otimes C_{mesh}",
    r"I_{tot} = K_{amb} \otimes L_{glob} + L_{emi} + \sum_{k=1}^{n} c_{spot}^k \{ I_{amb}^k + d^k (I_{diff}^k + I_{spec}^k) \}",
    r"C_{lit} = K_{diff} \otimes L_{diff}",
    r"C_{dark} = K_{dark} \otimes K_{diff} \otimes L_{diff}",
];

/// The highlights of the models, by the number in the module `scene`.
const HIGHLIGHTS: &[(f64, &str)] = &[
    (1.0, r"I_{spec} = \max(\mathbf{R} \cdot \mathbf{V}, 0)^{K_{shi}} K_{spec} \otimes L_{spec}"),
    (2.0, r"I_{spec} = \max(\mathbf{N} \cdot \mathbf{H}, 0)^{K_{shi}} K_{spec} \otimes L_{spec}"),
    (6.0, r"I_{spec} = \max(\mathbf{R} \cdot \mathbf{V}, 0)^{4} K_{spec} \otimes L_{spec}"),
];

static DOCUMENTS: LazyLock<Vec<Definition>> = LazyLock::new(|| definitions(MEANINGS).expect("they parse"));

/// Symbols that are numbers of a scene: the name, and the uniform; `#` is the light's number.
const NUMBERS: &[(&str, &str)] = &[
    ("K_amb", "material.ambient"),
    ("K_diff", "material.diffuse"),
    ("K_spec", "material.specular"),
    ("K_shi", "material.shininess"),
    ("F_0", "material.specular"),
    ("sigma", "finish.roughness"),
    ("K_dark", "finish.shade"),
    ("t", "finish.threshold"),
    ("L_emi", "material.emission"),
    ("L_glob", "global_ambient"),
    ("L_amb", "light[#].ambient"),
    ("L_diff", "light[#].diffuse"),
    ("L_spec", "light[#].specular"),
    ("L_exp", "light[#].exponent"),
    ("P_l", "light[#].position"),
    ("C_mesh", "mesh_color"),
    ("C_amb", "ambient_color"),
    ("C_light", "light_color"),
    ("C_sky", "sky"),
    ("C_ground", "ground"),
];

/// A point of a surface.
pub(super) struct Sample<'a> {
    pub(super) draw: &'a Draw,
    pub(super) printed: &'a [Definition],
    pub(super) used: &'a Used,
    pub(super) place: DVec3,
    pub(super) normal: DVec3,
    /// Values that no scene has, such as (u, v).
    pub(super) more: &'a dyn Fn(&str) -> Option<Value>,
    light: Cell<usize>,
}

fn number(value: f64) -> Option<Value> {
    Some(Value::Number(value))
}

fn given(vector: DVec3) -> Option<Value> {
    Some(Value::Vector(vector.to_array()))
}

impl<'a> Sample<'a> {
    pub(super) fn new(
        draw: &'a Draw,
        (printed, used): (&'a [Definition], &'a Used),
        (place, normal): (DVec3, DVec3),
        more: &'a dyn Fn(&str) -> Option<Value>,
    ) -> Self {
        Self { draw, printed, used, place, normal, more, light: Cell::new(0) }
    }

    /// The color of the picture: what is printed as the whole, else the sum over the lights.
    pub(super) fn color(&self) -> Result<[f64; 3], String> {
        let has = |name: &str| self.printed.iter().any(|definition| definition.name == name);
        let lit = uniform(self.draw, "material.diffuse").is_some();
        let name = if has("C") && !lit { "C" } else { "I_tot" };
        let name = if has("C") && lit && self.flat_toon() { "C" } else { name };
        match self.symbol(name)? {
            Value::Vector(color) => Ok(color),
            Value::Number(number) => Err(format!("`{name}` is {number}, not a color")),
        }
    }

    /// Whether the picture is hard toon alone, of which a formula gives the whole color.
    fn flat_toon(&self) -> bool {
        uniform(self.draw, "finish.diffuse_model") == Some(vec![4.0])
    }

    fn kind(&self, light: usize) -> f64 {
        uniform(self.draw, &format!("light[{light}].kind")).map_or(0.0, |kind| kind[0])
    }

    fn towards(&self) -> Option<DVec3> {
        let light = self.light.get();
        if let Some(towards) = vector(self.draw, "light_direction") {
            return Some(towards.normalize());
        }
        match self.kind(light) {
            0.0 => Some(-vector(self.draw, &format!("light[{light}].direction"))?.normalize()),
            _ => Some((vector(self.draw, &format!("light[{light}].position"))? - self.place).normalize()),
        }
    }

    /// The half spheres among the lights.
    fn dome(&self) -> Option<usize> {
        (0..8).find(|&light| self.kind(light) == 3.0)
    }

    /// Symbols that follow from the point and the kind of light.
    fn own(&self, name: &str) -> Option<Value> {
        let light = self.light.get();
        let eye = vector(self.draw, "eye");
        let weights = || vector(self.draw, &format!("light[{light}].attenuation"));
        match name {
            "N" => given(self.normal),
            "P" => given(self.place),
            "L" => given(self.towards()?),
            "V" => given((eye? - self.place).normalize()),
            "V_0" => given((eye? - matrix(self.draw, "model")?.w_axis.truncate()).normalize()),
            "A" => match vector(self.draw, "axis") {
                Some(axis) => given(axis.normalize()),
                None => match self.dome() {
                    Some(dome) => given(vector(self.draw, &format!("light[{dome}].direction"))?.normalize()),
                    // The soft toon's program with the half spheres' axis for its light.
                    None => given(self.towards()?),
                },
            },
            "C_sky" => self.dome().and_then(|dome| given(vector(self.draw, &format!("light[{dome}].diffuse"))?)),
            "C_ground" => self.dome().and_then(|dome| given(vector(self.draw, &format!("light[{dome}].ambient"))?)),
            "L_dir" => given(vector(self.draw, &format!("light[{light}].direction"))?.normalize()),
            "s_c" => number(weights()?.x),
            "s_l" => number(weights()?.y),
            "s_q" => number(weights()?.z),
            "pi" => number(std::f64::consts::PI),
            "alpha" => number(uniform(self.draw, "finish.roughness")?.first()?.powi(2)),
            "C_white" => Some(Value::Vector([1.0; 3])),
            "d" if self.kind(light) == 0.0 => number(1.0),
            "c_spot" if self.kind(light) != 2.0 => number(1.0),
            _ => None,
        }
    }

    /// The documents' meaning of a symbol.
    fn documented(&self, name: &str) -> Option<Result<Value, String>> {
        let formula = match name {
            "I_spec" => {
                // A program that does not ask for the eye has no highlight.
                let model = uniform(self.draw, "finish.specular_model").filter(|_| vector(self.draw, "eye").is_some());
                let model = model.map_or(0.0, |model| model[0]);
                if model == 0.0 {
                    return Some(Ok(Value::Vector([0.0; 3])));
                }
                HIGHLIGHTS.iter().find(|(number, _)| *number == model)?.1
            }
            "d" => r"d = \frac{1}{s_c + s_l r + s_q r^2}",
            "c_spot" => r"c_{spot} = \max(-\mathbf{L} \cdot \mathbf{L}_{dir}, 0)^{L_{exp}}",
            _ => {
                let known = DOCUMENTS.iter().find(|definition| definition.name == name)?;
                return Some(evaluate(&known.value, self));
            }
        };
        let parsed = definitions(&[formula]).expect("it parses");
        Some(evaluate(&parsed[0].value, self))
    }

    /// A table by linear interpolation between its texels, of which the first is for 0 and the last for 1.
    fn looked_up(&self, at: f64) -> Result<Value, String> {
        let is_table = |name: &str| ["highlight", "ramp"].contains(&name);
        let slot = self.draw.program.interface.samplers.iter().position(|slot| is_table(&slot.name));
        let texture = slot.and_then(|slot| self.draw.textures[slot].as_ref()).ok_or("no table")?;
        let Texels::Float(texels) = &texture.levels[0].texels else { return Err("no colors".to_owned()) };
        let x = at.clamp(0.0, 1.0) * (texels.len() - 1) as f64;
        let left = (x.floor() as usize).min(texels.len().saturating_sub(2));
        let part = x - left as f64;
        let channel = |i: usize| f64::from(texels[left][i]) * (1.0 - part) + f64::from(texels[left + 1][i]) * part;
        Ok(Value::Vector(std::array::from_fn(channel)))
    }
}

impl Values for Sample<'_> {
    fn symbol(&self, name: &str) -> Result<Value, String> {
        let printed = self.printed.iter().find(|definition| definition.name == name);
        if printed.is_some() {
            self.used.borrow_mut().insert(name.to_owned());
        }
        if name == "I_spec" && self.towards().is_some_and(|l| dot(self.normal.to_array(), l.to_array()) <= 0.0) {
            return Ok(Value::Vector([0.0; 3]));
        }
        if let Some(definition) = printed {
            return evaluate(&definition.value, self);
        }
        if let Some(value) = (self.more)(name).or_else(|| self.own(name)) {
            return Ok(value);
        }
        if let Some((_, leaf)) = NUMBERS.iter().find(|(known, _)| *known == name)
            && let Some(numbers) = uniform(self.draw, &leaf.replace('#', &self.light.get().to_string()))
        {
            return match numbers[..] {
                [one] => Ok(Value::Number(one)),
                [x, y, z] => Ok(Value::Vector([x, y, z])),
                _ => Err(format!("`{name}` has {} numbers", numbers.len())),
            };
        }
        self.documented(name).unwrap_or_else(|| Err(format!("`{name}` means nothing here")))
    }

    fn table(&self, _: &str, at: f64) -> Result<Value, String> {
        self.looked_up(at)
    }

    fn over_lights(&self, term: &Node) -> Result<Value, String> {
        let count = uniform(self.draw, "lights").map_or(0, |count| count[0] as usize);
        let mut sum = DVec3::ZERO;
        for light in 0..count {
            self.light.set(light);
            let part = if self.kind(light) == 3.0 {
                let dome = definitions(&[r"x = K_{amb} \otimes C_{dome}"]).expect("it parses");
                evaluate(&dome[0].value, self)?
            } else {
                evaluate(term, self)?
            };
            let Value::Vector(part) = part else { return Err("a light's part is a color".to_owned()) };
            sum += DVec3::from_array(part);
        }
        self.light.set(0);
        Ok(Value::Vector(sum.to_array()))
    }
}
