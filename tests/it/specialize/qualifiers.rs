//! Random programs with every qualifier of interpolation, by random scenes with every primitive: specialized, they draw the
//! same bytes.
//!
//! `RANDOM_SCENES=0..10000 cargo test --test it -- specialize::qualifiers` runs ten thousand.

use super::difference;
use crate::drawing::compiler;
use glisten::scene::{MemoryFiles, Scene};
use glisten::specialize::specialize_scene;
use glisten_front::source::SourceMap;
use glisten_verify::scene;
use std::fmt::Write;

const PRIMITIVES: [&str; 7] =
    ["points", "lines", "line_strip", "line_loop", "triangles", "triangle_strip", "triangle_fan"];
const QUALIFIERS: [&str; 6] = ["", "smooth", "noperspective", "flat", "centroid", "noperspective centroid"];
/// Types of varyings, and how many components they have.
const FLOATS: [(&str, usize); 4] = [("float", 1), ("vec2", 2), ("vec3", 3), ("vec4", 4)];
const INTEGERS: [&str; 3] = ["int", "uint", "ivec2"];
/// Values of uniforms: those that decide most come often.
const VALUES: [&str; 8] = ["0.0", "0.0", "1.0", "1.0", "-0.0", "2.5", "-0.75", "0.3"];

/// Seeds that found faults: the sign of `max(0.0, -0.0)`.
const FAULTS: [u64; 3] = [2782, 9406, 9630];

fn seeds() -> Vec<u64> {
    let Ok(asked) = std::env::var("RANDOM_SCENES") else { return (0..32).chain(FAULTS).collect() };
    let (first, end) = asked.split_once("..").expect("RANDOM_SCENES=first..end");
    (first.parse().expect("a number")..end.parse().expect("a number")).collect()
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % limit as u64) as usize
    }

    fn of<'a, T: ?Sized>(&mut self, list: &[&'a T]) -> &'a T {
        list[self.below(list.len())]
    }

    /// A number of a sixteenth.
    fn number(&mut self, low: i32, high: i32) -> f64 {
        f64::from(low) + self.below(((high - low) * 16) as usize) as f64 / 16.0
    }
}

/// A varying: its qualifier, type, name, and how many components it has; 0 of an integer.
struct Varying {
    qualifier: &'static str,
    ty: &'static str,
    name: String,
    components: usize,
}

/// The texts of a program, and the scene.
struct Made {
    vertex: String,
    fragment: String,
    scene: String,
}

fn varying(index: usize, random: &mut Random) -> Varying {
    let name = format!("v{index}");
    if random.below(4) == 0 {
        return Varying { qualifier: "flat", ty: random.of(&INTEGERS), name, components: 0 };
    }
    let (ty, components) = FLOATS[random.below(FLOATS.len())];
    Varying { qualifier: random.of(&QUALIFIERS), ty, name, components }
}

fn swizzle(name: &str, components: usize) -> String {
    if components == 1 { format!("{name}.x") } else { format!("{name}.{}", &"xyzw"[..components]) }
}

fn vertex(random: &mut Random, varyings: &[Varying]) -> String {
    let mut text = String::from(
        "#version 150\nin vec4 place;\nin vec4 data;\nin int kind;\nuniform float u[4];\nuniform int mode;\nuniform bool moves;\n",
    );
    let mut body = String::new();
    for Varying { qualifier, ty, name, components } in varyings {
        let _ = writeln!(text, "{qualifier} out {ty} {name};");
        let k = random.below(4);
        let value = match (*components, *ty) {
            (0, "int") => format!("kind + (mode == {k} ? 1 : 0)"),
            (0, "uint") => format!("uint(kind) * uint(mode + {k})"),
            (0, _) => format!("ivec2(kind, mode * kind + {k})"),
            (components, ty) => match random.below(5) {
                0 => format!("{} * u[{k}]", swizzle("data", components)),
                1 => format!("{ty}(u[{k}])"),
                2 => format!("{} + u[{k}] * {}", swizzle("data", components), swizzle("place", components)),
                3 => format!("mode > {k} ? {} : {ty}(0.5)", swizzle("data", components)),
                _ => swizzle("data", components),
            },
        };
        let _ = writeln!(body, "    {name} = {value};");
    }
    let _ = write!(text, "void main() {{\n{body}    gl_Position = moves ? place + vec4(u[0] * 0.125) : place;\n}}\n");
    text
}

fn fragment(random: &mut Random, varyings: &[Varying]) -> String {
    let mut text =
        String::from("#version 150\nuniform float u[4];\nuniform int mode;\nuniform bool moves;\nout vec4 color;\n");
    let mut body = String::new();
    for Varying { qualifier, ty, name, components } in varyings {
        let _ = writeln!(text, "{qualifier} in {ty} {name};");
        let k = random.below(4);
        let scalar = match (*components, *ty) {
            (0, "ivec2") => format!("float({name}.x - {name}.y)"),
            (0, _) => format!("float({name})"),
            (1, _) => name.clone(),
            (components, _) => format!("{name}.{}", &"xyzw"[random.below(components)..][..1]),
        };
        let term = match random.below(7) {
            0 => format!("fract({scalar} * 7.0)"),
            1 => format!("{scalar} * u[{k}]"),
            2 => format!("mix({scalar}, u[{k}], u[{}])", (k + 1) % 4),
            3 => format!("max({scalar}, u[{k}])"),
            4 => format!("pow(abs({scalar}), u[{k}])"),
            5 => format!("normalize(vec3({scalar}, u[{k}], 1.0)).x"),
            _ => format!("floor({scalar} * 4.0) / (1.0 + abs(u[{k}]))"),
        };
        let channel = random.of(&["x", "y", "z", "w"]);
        let line = match random.below(6) {
            0 => format!("if (mode == {k}) c.{channel} += {term};"),
            1 => format!("if (moves) c.{channel} *= {term};"),
            2 => format!("for (int i = 0; i < mode; ++i) c.{channel} += {term} * float(i);"),
            3 => format!("if ({scalar} > u[{k}]) c.{channel} -= {term};"),
            4 => format!("if (u[{k}] > 2.0 && {scalar} < 0.0) discard;"),
            _ => format!("c.{channel} += {term};"),
        };
        let _ = writeln!(body, "    {line}");
    }
    let _ = write!(text, "void main() {{\n    vec4 c = vec4(u[3], 0.0, 0.0, 1.0);\n{body}    color = c;\n}}\n");
    text
}

fn made(seed: u64) -> Made {
    let mut random = Random(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
    let random = &mut random;
    let varyings: Vec<Varying> = (0..2 + random.below(5)).map(|index| varying(index, random)).collect();
    let (vertex, fragment) = (vertex(random, &varyings), fragment(random, &varyings));
    let n_vertices = 3 + random.below(7);
    let mut numbers = |low, high, count: usize| -> Vec<f64> { (0..count).map(|_| random.number(low, high)).collect() };
    let place: Vec<f64> = (0..n_vertices)
        .flat_map(|_| {
            let [x, y, z, w] = [numbers(-2, 2, 1)[0], numbers(-2, 2, 1)[0], numbers(-1, 1, 1)[0], numbers(0, 3, 1)[0]];
            [x, y, z * 0.5, w + 0.5]
        })
        .collect();
    let data = numbers(-3, 3, n_vertices * 4);
    // An attribute may be the same at all vertices.
    let same = random.below(3) == 0;
    let kinds: Vec<usize> =
        (0..n_vertices).map(|vertex| if same { 2 } else { (vertex * 5 + seed as usize) % 4 }).collect();
    let mut state = format!("primitive = \"{}\"\n", random.of(&PRIMITIVES));
    for (key, values) in [
        ("provoking", &["\"first\"", "\"last\""][..]),
        ("cull", &["\"none\"", "\"none\"", "\"back\"", "\"front\""]),
        ("depth_test", &["true", "false"]),
        ("blend", &["\"none\"", "\"none\"", "\"alpha\"", "\"add\""]),
    ] {
        let _ = writeln!(state, "{key} = {}", random.of(values));
    }
    if random.below(2) == 0 {
        let indices: Vec<usize> = (0..3 + random.below(9)).map(|_| random.below(n_vertices)).collect();
        let _ = writeln!(state, "indices = {indices:?}");
    }
    let dynamic: Vec<&str> = ["u", "mode", "moves"].into_iter().filter(|_| random.below(5) == 0).collect();
    let u: Vec<&str> = (0..4).map(|_| random.of(&VALUES)).collect();
    let scene = format!(
        "framebuffer = {{ width = 24, height = 24 }}\n[[draw]]\nvertex = \"r.vert\"\nfragment = \"r.frag\"\n{state}\
         dynamic = {dynamic:?}\n[draw.attributes]\nplace = {{ size = 4, values = {place:?} }}\n\
         data = {{ size = 4, values = {data:?} }}\nkind = {{ size = 1, kind = \"int\", values = {kinds:?} }}\n\
         [draw.uniforms]\nu = [{}]\nmode = {}\nmoves = {}\n",
        u.join(", "),
        random.below(4),
        random.below(2) == 0,
    );
    Made { vertex, fragment, scene }
}

fn loaded(made: &Made) -> Result<Scene, String> {
    let files = [("r.toml", made.scene.as_str()), ("r.vert", &made.vertex), ("r.frag", &made.fragment)];
    let loaded = scene::load("r.toml", &MemoryFiles::new(files), &compiler());
    let errors = loaded.diagnostics.iter().filter(|found| found.is_error()).map(|found| found.message.clone());
    let errors: Vec<String> = errors.collect();
    loaded.scene.ok_or_else(|| errors.join("; "))
}

#[test]
fn random_scenes_draw_the_same_bytes() {
    let (mut wrong, mut n_drawn) = (Vec::new(), 0);
    for seed in seeds() {
        let made = made(seed);
        let Made { vertex, fragment, scene: text } = &made;
        let found = match loaded(&made) {
            Err(message) => Some(format!("it is refused: {message}")),
            Ok(scene) => {
                n_drawn +=
                    usize::from(super::bits(&scene).is_ok_and(|bits| bits.iter().any(|value| *value != bits[0])));
                let specialized = specialize_scene(&scene, &SourceMap::default(), &[]);
                let fault = specialized.draws.iter().find_map(|draw| draw.fault.clone());
                fault.or_else(|| difference(&scene, &specialized))
            }
        };
        wrong.extend(found.map(|what| format!("seed {seed}: {what}\n{vertex}\n{fragment}\n{text}")));
        if wrong.len() >= 3 {
            break;
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    assert!(n_drawn * 2 > seeds().len(), "only {n_drawn} pictures show anything");
}
