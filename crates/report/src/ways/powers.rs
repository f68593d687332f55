//! Powers by other means: squaring, and Schlick's rational form (90).
//!
//! *In:* a scene and one of its draws. *Out:* the scene with each `pow(x, n)` of the draw's program replaced, whose `n` is a
//! number that the scene fixes. *Holds:* squaring takes whole exponents from 2 to [`LARGEST`], and is the power but for
//! rounding; the rational form takes only bases that are in [0, 1] all over the picture.

use super::edit::{Edited, with_draw};
use super::fixed::{Fixed, Place};
use super::names::Names;
use super::probe;
use glisten_front::builtin::BuiltinFunction;
use glisten_front::hir::{ExprId, ExprKind, Stage, TypeId};
use glisten_scene::Scene;
use std::fmt::Write;

/// The largest exponent that is written as products.
const LARGEST: f64 = 1024.0;
/// A cosine may exceed 1 by rounding.
const ROUNDING: f64 = 1e-6;

/// A power with a fixed exponent.
#[derive(Clone, Copy, Debug)]
struct Power {
    expr: ExprId,
    base: ExprId,
    exponent: f64,
}

/// The scene with powers of whole exponents as products; the exponents.
pub(super) fn squared(scene: &Scene, index: usize) -> Option<(Scene, Vec<u32>)> {
    let is_whole = |power: &Power| power.exponent.fract() == 0.0 && (2.0..=LARGEST).contains(&power.exponent);
    let draw = scene.draws.get(index)?;
    let mut edited = Edited::of(draw)?;
    let mut exponents = Vec::new();
    for stage in [Stage::Vertex, Stage::Fragment] {
        for power in powers(scene, index, stage).into_iter().filter(is_whole) {
            let exponent = power.exponent as u32;
            rewrite(&mut edited, stage, power, &format!("power_{exponent}"), &|name, ty| products(name, ty, exponent));
            exponents.push(exponent);
        }
    }
    exponents.sort_unstable();
    exponents.dedup();
    (!exponents.is_empty()).then_some(())?;
    Some((with_draw(scene, index, edited.draw(draw)?)?, exponents))
}

/// The scene with the powers of cosines in the fragment stage in Schlick's rational form; the exponents.
pub(super) fn rational(scene: &Scene, index: usize) -> Option<(Scene, Vec<f64>)> {
    let draw = scene.draws.get(index)?;
    let mut edited = Edited::of(draw)?;
    let mut exponents = Vec::new();
    for power in powers(scene, index, Stage::Fragment) {
        let scalar = draw.program.stage(Stage::Fragment)?.expr(power.base).ty == TypeId::FLOAT;
        if !scalar || power.exponent <= 1.0 {
            continue;
        }
        let [low, high] = probe::range(scene, index, power.base).unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        if low < -ROUNDING || high > 1.0 + ROUNDING {
            continue;
        }
        let n = decimal(power.exponent);
        let text =
            move |name: &str, ty: &str| format!("{ty} {name}({ty} t) {{\n    return t / ({n} - t * {n} + t);\n}}\n");
        let name = format!("schlick_{}", power.exponent).replace(['.', '-'], "_");
        rewrite(&mut edited, Stage::Fragment, power, &name, &text);
        exponents.push(power.exponent);
    }
    exponents.sort_unstable_by(f64::total_cmp);
    exponents.dedup();
    (!exponents.is_empty()).then_some(())?;
    Some((with_draw(scene, index, edited.draw(draw)?)?, exponents))
}

/// The powers of a stage whose exponent is one number, in the functions that `main` reaches.
fn powers(scene: &Scene, index: usize, stage: Stage) -> Vec<Power> {
    let Some(draw) = scene.draws.get(index) else { return Vec::new() };
    let Some(shader) = draw.program.stage(stage) else { return Vec::new() };
    let (fixed, names) = (Fixed::of(draw, &scene.framebuffer, stage), Names::of(shader));
    let at = Place { types: &draw.program.types, shader, names: &names };
    let mut found: Vec<Power> = Vec::new();
    for function in shader.main.map(|main| shader.callees_first(main)).unwrap_or_default() {
        shader.visit_body(shader.function(function).body.as_deref().unwrap_or(&[]), &mut |id| {
            let ExprKind::BuiltinCall(BuiltinFunction::Pow, list) = &shader.expr(id).kind else { return };
            let [base, exponent] = list.as_slice() else { return };
            if shader.expr(*base).ty == shader.expr(id).ty
                && let Some(exponent) = fixed.scalar(&at, function, *exponent)
                && exponent.is_finite()
            {
                found.push(Power { expr: id, base: *base, exponent });
            }
        });
    }
    found
}

/// Puts a call of a function of the base in the place of a power.
fn rewrite(edited: &mut Edited, stage: Stage, power: Power, wanted: &str, text: &dyn Fn(&str, &str) -> String) {
    let types = &edited.types;
    let open = if stage == Stage::Vertex { &mut edited.vertex } else { &mut edited.fragment };
    let ty = open.shader.expr(power.base).ty;
    let known = open.shader.functions().find(|(_, function)| {
        let same = function.body.is_none() && function.ret == ty;
        same && function.name.strip_prefix(wanted).is_some_and(|rest| rest.is_empty() || is_number(rest))
    });
    let function = match known.map(|(id, _)| id) {
        Some(id) => id,
        None => {
            let name = open.fresh(types, wanted);
            let _ = write!(open.appended, "\n{}", text(&name, &types.name(ty)));
            open.prototype(&name, ty, &[ty])
        }
    };
    open.replace(power.expr, function, vec![power.base]);
}

fn is_number(rest: &str) -> bool {
    rest.strip_prefix('_').is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()))
}

/// `x^n` by squaring and multiplying.
fn products(name: &str, ty: &str, n: u32) -> String {
    let mut text = format!("{ty} {name}({ty} x) {{\n");
    let mut factors: Vec<String> = Vec::new();
    let (mut square, mut exponent) = (String::from("x"), 1u32);
    loop {
        if n & exponent != 0 {
            factors.push(square.clone());
        }
        if exponent > n / 2 {
            break;
        }
        exponent *= 2;
        let _ = writeln!(text, "    {ty} x{exponent} = {square} * {square};");
        square = format!("x{exponent}");
    }
    let _ = write!(text, "    return {};\n}}\n", factors.join(" * "));
    text
}

/// A literal of GLSL that reads back as the nearest f32.
pub(super) fn decimal(value: f64) -> String {
    format!("{:?}", value as f32)
}

#[cfg(test)]
mod tests {
    use super::products;

    #[test]
    fn products_are_as_many_as_the_bits_of_the_exponent() {
        assert_eq!(products("p", "float", 2), "float p(float x) {\n    float x2 = x * x;\n    return x2;\n}\n");
        let five = products("p", "vec3", 5);
        assert!(five.contains("vec3 x4 = x2 * x2;") && five.contains("return x * x4;"), "{five}");
        assert_eq!(products("p", "float", 1000).matches('*').count(), 9 + 5);
    }
}
