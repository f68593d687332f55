//! Is a table faster? Work by count, and GPU time as a ratio.

use super::scenes::{At, Ball, By, Highlight, errors, files, picture, scene};
use glisten::report::{self, Weights};
use glisten::{Compiler, Gpu};
use glisten_gpu::Via;
use std::fmt::Write;

/// Fragments that outnumber vertices, and vertices that outnumber fragments.
const MESHES: [u32; 2] = [64, 512];
const SIZE: u32 = 256;
const EXPONENTS: [u32; 2] = [4, 32];

/// The ways to draw a highlight of an exponent, those at the vertices first.
fn ways(exponent: u32) -> Vec<Highlight> {
    let mut ways = Vec::new();
    for at in [At::Vertices, At::Fragments] {
        let kinds = [By::Pow, By::Squaring, By::Table(256, false), By::Table(256, true)];
        ways.extend(kinds.map(|by| Highlight::new(at, by, exponent)));
        if exponent == 4 && at == At::Vertices {
            ways.push(Highlight::new(at, By::Mirror, exponent));
        }
    }
    ways
}

/// A number with commas between thousands.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// The table of work and errors.
pub(crate) fn work() -> Result<String, String> {
    let mut text = String::from(
        "| k | highlight | operations, 64x32 | lookups | operations, 512x256 | lookups | largest error, 64x32 |\n\
         | --- | --- | --- | --- | --- | --- | --- |",
    );
    let weights = Weights::default();
    for exponent in EXPONENTS {
        let balls = MESHES.map(|segments| Ball { size: SIZE, segments });
        let truth = picture(&scene(Highlight::new(At::Fragments, By::Pow, exponent), balls[0])?)?;
        for way in ways(exponent) {
            let _ = write!(text, "\n| {exponent} | {} |", way.name());
            for ball in balls {
                let counted = work_of(&scene(way, ball)?, &weights)?;
                let _ = write!(text, " {} | {} |", grouped(counted.0), grouped(counted.1));
            }
            let error = errors(&picture(&scene(way, balls[0])?)?, &truth).0;
            let shown = if way.by == By::Mirror { "another curve".into() } else { format!("{error:.1e}") };
            let _ = write!(text, " {shown} |");
        }
    }
    Ok(text)
}

fn work_of(scene: &glisten::scene::Scene, weights: &Weights) -> Result<(u64, u64), String> {
    let counted = report::work(scene, weights).map_err(|errors| format!("{errors:?}"))?;
    Ok((counted.operations, counted.texture_lookups))
}

/// The table of times: ratios to `pow` at the same place.
pub(crate) fn time() -> Result<String, String> {
    let gpu = Gpu::new(Some("software")).map_err(|error| error.to_string())?;
    let mut text = String::from(
        "| k | highlight | mesh | time, `pow` at the vertices is 1 | 95 % interval |\n| --- | --- | --- | --- | --- |",
    );
    for exponent in EXPONENTS {
        let ways = ways(exponent);
        let mut scene = Ball { size: SIZE, segments: MESHES[0] }.text(&ways[0].keys("0"));
        let meshes: Vec<String> = MESHES.iter().map(|segments| format!("[{segments}, {}]", segments / 2)).collect();
        let _ = write!(scene, "\n[report]\ntessellations = [{}]\n", meshes.join(", "));
        for (number, way) in ways.iter().enumerate() {
            let truth = if number == 0 { "truth = true\n" } else { "" };
            let _ = write!(
                scene,
                "\n[[report.way]]\nname = \"{}\"\nmodel = \"k\"\n{truth}set = {{ {} }}\n",
                way.name(),
                way.keys(&number.to_string())
            );
        }
        let mut files = files(&ways);
        files.0.insert("s.toml".into(), scene.into_bytes());
        let options = report::Options {
            via: Via::Spirv,
            specialized: None,
            ways: report::Ways::Declared,
            weights: Weights::default(),
            rounds: None,
            time: Some(std::time::Duration::from_secs(40)),
            machine: report::Machine::default(),
        };
        let compiler = Compiler::new(glisten::Options::default());
        let found = report::run("s.toml", &files, &compiler, &gpu, &options, &mut ());
        let found = found.map_err(|error| format!("{error:?}"))?;
        for mesh in MESHES {
            let of_mesh = || found.ways.iter().filter(|way| way.tessellation.is_some_and(|[n, _]| n == mesh));
            let Some(base) = of_mesh().next() else { continue };
            for way in of_mesh() {
                let scaled = |x: f64| x / base.ratio.median;
                let [low, high] = way.ratio.interval;
                let _ = write!(
                    text,
                    "\n| {exponent} | {} | {mesh}x{} | {:.2} | {:.2} to {:.2} |",
                    way.name,
                    mesh / 2,
                    scaled(way.ratio.median),
                    scaled(low),
                    scaled(high)
                );
            }
        }
    }
    let adapter = gpu.adapter();
    let _ = write!(text, "\n\nMeasured on {}, {}.", adapter.name, adapter.driver);
    Ok(text)
}
