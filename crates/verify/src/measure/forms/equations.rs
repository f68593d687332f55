//! Closed forms of lights and of the sums: (93) to (101).

use super::{Form, InputKind, cosine_power, dot, forms, half, norm};
use crate::measure::vector::{V, add, mul, scale, sub, unit};
use crate::measure::{Answer, Args};

/// The members of a light, in order.
struct Light {
    kind: f64,
    position: V,
    direction: V,
    ambient: V,
    diffuse: V,
    specular: V,
    weights: V,
    exponent: f64,
}

struct Material {
    ambient: V,
    diffuse: V,
    specular: V,
    shininess: f64,
}

fn light(a: &Args<'_>) -> Light {
    Light {
        kind: a.f(),
        position: a.v(),
        direction: a.v(),
        ambient: a.v(),
        diffuse: a.v(),
        specular: a.v(),
        weights: a.v(),
        exponent: a.f(),
    }
}

fn material(a: &Args<'_>) -> Material {
    let material = Material { ambient: a.v(), diffuse: a.v(), specular: a.v(), shininess: a.f() };
    // The emission belongs to no light.
    a.v();
    material
}

impl Light {
    fn towards(&self, p: V) -> V {
        match self.kind {
            0.0 => unit(scale(-1.0, self.direction)),
            3.0 => [0.0; 3],
            _ => unit(sub(self.position, p)),
        }
    }

    fn attenuation(&self, p: V) -> f64 {
        if self.kind == 0.0 { 1.0 } else { weighted(norm(sub(self.position, p)), self.weights) }
    }

    /// The light of two half spheres: the sky's color at the center of the sky, the ground's opposite.
    fn dome(&self, n: V) -> V {
        let half = 0.5 * (1.0 + dot(n, unit(self.direction)));
        add(self.ambient, scale(half, sub(self.diffuse, self.ambient)))
    }

    /// Its part of (101) for the sum of the diffuse and the specular reflection, and its condition number.
    fn around(&self, k_amb: V, (p, n, l): (V, V, V), direct: V) -> Option<(V, f64)> {
        if self.kind == 3.0 {
            return Some((mul(k_amb, self.dome(n)), 1.0));
        }
        let (beam, condition) = self.beam(l)?;
        let lit = add(mul(k_amb, self.ambient), scale(self.attenuation(p), direct));
        Some((scale(beam, lit), condition))
    }

    /// The factor of the beam, and its condition number.
    fn beam(&self, l: V) -> Option<(f64, f64)> {
        if self.kind != 2.0 {
            return Some((1.0, 1.0));
        }
        let answer = cosine_power(scale(-1.0, l), unit(self.direction), self.exponent, 2.0)?;
        Some((answer.values.first().copied()?, answer.condition.max(1.0)))
    }
}

/// (96), by powers of r.
fn weighted(r: f64, s: V) -> f64 {
    1.0 / dot(s, [1.0, r, r * r])
}

/// A term of (101), with its condition number and its distance from the gate of the highlight.
fn term(light: &Light, material: &Material, p: V, n: V, v: V) -> Option<(V, f64, f64)> {
    let l = light.towards(p);
    let cos = dot(n, l);
    let (mut specular, mut condition) = ([0.0; 3], 1.0);
    if cos > 0.0 {
        let (h, blur) = half(l, v)?;
        let power = cosine_power(n, h, material.shininess, blur)?;
        specular = scale(power.values.first().copied()?, mul(material.specular, light.specular));
        condition = power.condition.max(1.0);
    }
    let diffuse = scale(cos.max(0.0), mul(material.diffuse, light.diffuse));
    let (value, beam_condition) = light.around(material.ambient, (p, n, l), add(diffuse, specular))?;
    let gate = if light.kind == 3.0 { f64::INFINITY } else { cos.abs() };
    Some((value, condition * beam_condition, gate))
}

fn single(a: &Args<'_>) -> V {
    add(add(a.v(), a.v()), a.v())
}

/// I_amb + d (I_diff + I_spec), and the magnitude of the sum.
fn attenuated(a: &Args<'_>) -> (V, f64) {
    let (ambient, diffuse, specular, d) = (a.v(), a.v(), a.v(), a.f());
    (add(ambient, add(scale(d, diffuse), scale(d, specular))), 4.0 + 8.0 * d)
}

pub(super) static FORMS: &[Form] = forms! {
    "attenuation" "lightDistance(vec3,vec3)" [Point, Point] |a| Some(Answer::relative([norm(sub(a.v(), a.v()))]));
    "attenuation" "attenuationInverseSquare(float)" [Distance] |a| Some(Answer::relative([a.f().powi(-2)]));
    "attenuation" "attenuation(float,vec3)" [Distance, Weights] |a| Some(Answer::relative([weighted(a.f(), a.v())]));
    "spot" "spotFactor(vec3,vec3,float)" [Opposed, Exponent]
        |a| cosine_power(scale(-1.0, a.d()), a.d(), a.f(), 2.0);
    "illumination" "illumination(vec3,vec3,vec3)" [Intensity, Intensity, Intensity] |a| Some(Answer::new(single(a), 12.0));
    "illumination" "illumination(vec3,vec3,vec3,float)" [Intensity, Intensity, Intensity, Gain] |a| {
        let (sum, scale) = attenuated(a);
        Some(Answer::new(sum, scale))
    };
    "illumination" "illumination(vec3,vec3,vec3,float,float)" [Intensity, Intensity, Intensity, Gain, Unit] |a| {
        let (sum, size) = attenuated(a);
        Some(Answer::new(scale(a.f(), sum), size))
    };
    "illumination" "background(vec3,vec3,vec3)" [Color, Intensity, Color] |a| Some(Answer::new(add(mul(a.v(), a.v()), a.v()), 5.0));
    "lights" "lightVector(Light,vec3)" [Light, Point] |a| Some(Answer::new(light(a).towards(a.v()), 1.0));
    "lights" "lightAttenuation(Light,vec3)" [Light, Point] |a| Some(Answer::relative([light(a).attenuation(a.v())]));
    "lights" "lightBeam(Light,vec3)" [Light, Direction] |a| {
        let (value, condition) = light(a).beam(a.d())?;
        Some(Answer::new([value], 1.0).conditioned(condition))
    };
    "lights" "lightDome(Light,vec3)" [Light, Direction] |a| Some(Answer::new(light(a).dome(a.d()), 4.0));
    "lights" "lightTerm(Light,vec3,vec3,vec3,vec3,vec3,vec3)" [Light, Color, Point, Direction, Direction, Intensity, Intensity] |a| {
        let (light, k_amb, p, n, l) = (light(a), a.v(), a.v(), a.d(), a.d());
        let (value, condition) = light.around(k_amb, (p, n, l), add(a.v(), a.v()))?;
        Some(Answer::new(value, 24.0).conditioned(condition))
    };
    "lights" "lightTerm(Light,Material,vec3,vec3,vec3)" [Light, Material, Point, Direction, Direction] |a| {
        let (light, material) = (light(a), material(a));
        let (value, condition, jump) = term(&light, &material, a.v(), a.d(), a.d())?;
        Some(Answer::new(value, 4.0).conditioned(condition).jumping(jump))
    };
};
