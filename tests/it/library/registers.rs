//! Compares the two programs that the article prints, run by an interpreter of their eight instructions, with the
//! library.

use super::{call, function};
use glisten_reference::Precision;
use glisten_verify::evaluate::table;
use glisten_verify::scene::Filter;
use std::collections::BTreeMap;
use std::sync::Arc;

type Register = [f64; 4];

/// A vertex processor of the time: named registers of four components.
#[derive(Default)]
struct Machine(BTreeMap<String, Register>);

impl Machine {
    fn set(mut self, name: &str, value: Register) -> Self {
        self.0.insert(name.to_owned(), value);
        self
    }

    /// A source operand: a sign, a register, and components, of which the last is repeated: `-r1`, `c12.y`.
    fn read(&self, source: &str) -> Register {
        let (sign, source) = source.strip_prefix('-').map_or((1.0, source), |source| (-1.0, source));
        let (name, swizzle) = source.split_once('.').unwrap_or((source, "xyzw"));
        let value = self.0.get(name).unwrap_or_else(|| panic!("{name} is not set"));
        let last = swizzle.len() - 1;
        std::array::from_fn(|i| sign * value[component(swizzle.as_bytes()[i.min(last)])])
    }

    /// Runs a line: `mad r0, r0, r1, r1`. The result goes to all components of the destination, or to those that it
    /// names.
    fn run(&mut self, line: &str) {
        let (name, operands) = line.split_once(' ').expect("an instruction and its operands");
        let mut operands = operands.split(',').map(str::trim);
        let target = operands.next().expect("a target");
        let sources: Vec<Register> = operands.map(|source| self.read(source)).collect();
        let each = |f: fn(&[f64]) -> f64| {
            std::array::from_fn(|i| f(&sources.iter().map(|source| source[i]).collect::<Vec<f64>>()))
        };
        let dot = |count: usize| [(0..count).map(|i| sources[0][i] * sources[1][i]).sum::<f64>(); 4];
        let result = match name {
            "mov" => sources[0],
            "add" => each(|x| x[0] + x[1]),
            "mul" => each(|x| x[0] * x[1]),
            "mad" => each(|x| x[0] * x[1] + x[2]),
            "dp3" => dot(3),
            "dp4" => dot(4),
            _ => panic!("no instruction `{name}`"),
        };
        let (name, mask) = target.split_once('.').unwrap_or((target, "xyzw"));
        let register = self.0.entry(name.to_owned()).or_default();
        mask.bytes().map(component).for_each(|i| register[i] = result[i]);
    }

    fn run_all(&mut self, lines: &[&str]) {
        lines.iter().for_each(|line| self.run(line));
    }
}

fn component(letter: u8) -> usize {
    "xyzw".bytes().position(|other| other == letter).expect("a component")
}

/// The position, the same in both programs.
const POSITION: [&str; 4] = ["dp4 oPos.x, v0, c0", "dp4 oPos.y, v0, c1", "dp4 oPos.z, v0, c2", "dp4 oPos.w, v0, c3"];

/// Program `hemisphere`: c12 constants, c15 color of the mesh, c18 upper and c19 lower half sphere, c20 axis.
const HEMISPHERE: [&str; 8] = [
    "dp3 r0, v3, c20",
    "mov r1, c12.y",
    "mad r0, r0, r1, r1",
    "mov r1, c19",
    "add r1, c18, -r1",
    "mad r0, r1, r0, c19",
    "mul oD0, r0, c15",
    "mov oT0, v7",
];

/// Program `soft`: c13 direction of the light.
const SOFT: [&str; 5] =
    ["mov oD0, c15", "dp3 r0.w, v3, c13", "mul r0.w, r0.w, c12.y", "add oT1.xy, r0.w, c12.y", "mov oT0, v7"];

/// Directions, normalized as precisely as f32 allows.
fn directions() -> Vec<[f32; 3]> {
    (0..200)
        .map(|i| {
            let (a, b) = (f64::from(i) * 2.399_963, 1.0 - f64::from(i) / 99.5);
            let r = (1.0 - b * b).max(0.0).sqrt();
            [(r * a.cos()) as f32, b as f32, (r * a.sin()) as f32]
        })
        .collect()
}

fn wide(v: [f32; 3], w: f64) -> Register {
    [f64::from(v[0]), f64::from(v[1]), f64::from(v[2]), w]
}

/// The registers that both programs read, with a matrix that a scene could have.
fn machine(normal: [f32; 3]) -> Machine {
    Machine::default()
        .set("v0", [0.5, -0.25, 2.0, 1.0])
        .set("v3", wide(normal, 1.0))
        .set("v7", [0.25, 0.75, 0.0, 1.0])
        .set("c0", [1.5, 0.0, 0.0, 0.1])
        .set("c1", [0.0, 2.0, 0.0, -0.2])
        .set("c2", [0.0, 0.0, -1.0, 0.5])
        .set("c3", [0.0, 0.0, -1.0, 4.0])
        .set("c12", [0.0, 0.5, 1.0, 2.0])
        .set("c15", [0.9, 0.8, 0.7, 1.0])
}

#[test]
fn the_hemisphere_program_gives_the_librarys_colors() {
    let library = function("hemisphere", "hemisphere(vec3,vec3,vec3,vec3)", &[]);
    let (axis, sky, ground) = ([0.6_f32, 0.8, 0.0], [0.5_f32, 0.75, 1.0], [0.5_f32, 0.375, 0.125]);
    let rows: Vec<f32> = directions().iter().flat_map(|normal| [*normal, axis, sky, ground].concat()).collect();
    for (normal, color) in directions().into_iter().zip(call(&library, &rows)) {
        let mut machine =
            machine(normal).set("c18", wide(sky, 1.0)).set("c19", wide(ground, 1.0)).set("c20", wide(axis, 0.0));
        machine.run_all(&POSITION);
        machine.run_all(&HEMISPHERE);
        let mesh = machine.read("c15");
        for (i, color) in color.iter().enumerate() {
            let difference = (machine.read("oD0")[i] - color * mesh[i]).abs();
            // f32 vectors are slightly longer or shorter than 1, and the library limits the weight to [0, 1].
            assert!(difference < 1e-7, "{normal:?}: {difference}");
        }
        assert_eq!(machine.read("oPos"), [0.85, -0.7, -1.5, 2.0]);
        assert_eq!(machine.read("oT0"), [0.25, 0.75, 0.0, 1.0]);
    }
}

#[test]
fn the_soft_program_gives_the_librarys_coordinate_and_colors() {
    let factor = function("half_lambert", "halfLambertFactor(vec3,vec3)", &[]);
    let register = function("half_lambert", "halfLambertDot(vec3,vec4)", &[]);
    let soft = function("toon", "toonSoft(sampler2D,vec3,vec3)", &[]);
    // A ramp whose second derivative is at most 2, so that a linear filter of 256 texels is off by 2 / 8 / 255^2.
    let ramp = |x: f64| [1.0 - (1.0 - x) * (1.0 - x), x * x, 0.5];
    let texel = |i: u32| {
        let [r, g, b] = ramp(f64::from(i) / 255.0);
        [r as f32, g as f32, b as f32, 1.0]
    };
    let texels = Arc::new(table((0..256).map(texel).collect(), Filter::Linear));
    let light = [0.48_f32, 0.6, 0.64];
    let rows: Vec<f32> = directions().iter().flat_map(|normal| [*normal, light].concat()).collect();
    let halved = light.map(|x| x / 2.0).into_iter().chain([0.5]).collect::<Vec<f32>>();
    let registers: Vec<f32> = directions().iter().flat_map(|normal| [&normal[..], &halved].concat()).collect();
    let colors = soft.reference(&rows, &[texels], Precision::F64).expect("it runs");
    let coordinates = call(&factor, &rows).into_iter().zip(call(&register, &registers)).zip(colors);
    for (normal, ((plain, dotted), color)) in directions().into_iter().zip(coordinates) {
        let mut machine = machine(normal).set("c13", wide(light, 0.0));
        machine.run_all(&POSITION);
        machine.run_all(&SOFT);
        let u = machine.read("oT1")[0];
        assert!((plain[0] - u.clamp(0.0, 1.0)).abs() < 1e-15, "{normal:?}");
        assert!((dotted[0] - u.clamp(0.0, 1.0)).abs() < 1e-15, "{normal:?}");
        for (ours, theirs) in ramp(u.clamp(0.0, 1.0)).iter().zip(&color) {
            assert!((ours - theirs).abs() < 4e-6, "{normal:?}: {ours} {theirs}");
        }
        assert_eq!(machine.read("oD0"), machine.read("c15"));
        assert_eq!(machine.read("oT1")[0], machine.read("oT1")[1]);
    }
}

#[test]
fn the_interpreter_masks_swizzles_and_negates() {
    let mut machine = Machine::default().set("a", [1.0, 2.0, 3.0, 4.0]).set("b", [5.0, 6.0, 7.0, 8.0]);
    machine.run_all(&["mov r.xz, -a.wzyx", "dp3 d, a, b", "dp4 e.y, a, b", "mad f, a.y, b.xx, a"]);
    assert_eq!(machine.read("r"), [-4.0, 0.0, -2.0, 0.0]);
    assert_eq!(machine.read("d"), [38.0; 4]);
    assert_eq!(machine.read("e"), [0.0, 70.0, 0.0, 0.0]);
    assert_eq!(machine.read("f"), [11.0, 12.0, 13.0, 14.0]);
}
