//! Is a table faster? Work by count, and GPU time as a ratio.

use super::scenes::{Ball, By, Highlight, Place, errors, files, picture, scene};
use glisten::{Compiler, Gpu, Options};
use glisten_gpu::Via;
use glisten_report as report;
use glisten_report::Weights;
use std::fmt::Write;
use std::time::Duration;

/// Fragments that outnumber vertices, and vertices that outnumber fragments.
const MESHES: [u32; 2] = [64, 512];
const SIZE: u32 = 256;
const EXPONENTS: [u32; 2] = [4, 32];
/// The limit of timing for a mesh and an exponent.
const TIME: Duration = Duration::from_secs(30);

/// The ways to draw a highlight of an exponent, those at the vertices first.
fn ways(exponent: u32) -> Vec<Highlight> {
    let mut ways = Vec::new();
    for at in [Place::Vertices, Place::Fragments] {
        let kinds = [By::Pow, By::Squaring, By::Table(256, false), By::Table(256, true)];
        ways.extend(kinds.map(|by| Highlight::new(at, by, exponent)));
        if exponent == 4 && at == Place::Vertices {
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
        let truth = picture(&scene(Highlight::new(Place::Fragments, By::Pow, exponent), balls[0])?)?;
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
    let steps = report::steps(scene).map_err(|errors| format!("{errors:?}"))?;
    let counted = report::work(&steps, weights, glisten::emit::FloatWidth::Single);
    Ok((counted.operations, counted.texture_lookups))
}

/// The table of times: ratios to `pow` at the vertices of the same mesh, round by round.
pub(crate) fn time() -> Result<String, String> {
    let gpu = Gpu::new(Some("software")).map_err(|error| error.to_string())?;
    let mut text = String::from(
        "| k | highlight | time, 64x32 | 95 % interval | time, 512x256 | 95 % interval |\n\
         | --- | --- | --- | --- | --- | --- |",
    );
    for exponent in EXPONENTS {
        let ways = ways(exponent);
        let [few, many] = MESHES.map(|segments| timed(&gpu, &ways, Ball { size: SIZE, segments }));
        for (way, (few, many)) in ways.iter().zip(few?.into_iter().zip(many?)) {
            let _ = write!(text, "\n| {exponent} | {} |", way.name());
            for [median, low, high] in [few, many] {
                let _ = write!(text, " {median:.2} | {low:.2} to {high:.2} |");
            }
        }
    }
    let adapter = gpu.adapter();
    let _ =
        write!(text, "\n\nTimes are ratios to the first way of each exponent; {}, {}.", adapter.name, adapter.driver);
    Ok(text)
}

/// The ratio of the time of each way to that of the first, and its interval.
fn timed(gpu: &Gpu, ways: &[Highlight], ball: Ball) -> Result<Vec<[f64; 3]>, String> {
    let Some(first) = ways.first() else { return Ok(Vec::new()) };
    let mut scene = ball.text(&first.keys("0"));
    let mesh = format!("[{}, {}]", ball.segments, ball.segments / 2);
    let _ = write!(scene, "\n[report]\ntessellations = [{mesh}]\ntruth_tessellation = {mesh}\n");
    for (number, way) in ways.iter().enumerate() {
        let truth = if number == 0 { "truth = true\n" } else { "" };
        let (name, keys) = (way.name(), way.keys(&number.to_string()));
        let _ = write!(scene, "\n[[report.way]]\nname = \"{name}\"\nmodel = \"k\"\n{truth}set = {{ {keys} }}\n");
    }
    let mut files = files(ways);
    files.0.insert("s.toml".into(), scene.into_bytes());
    let options = report::Options {
        via: Via::Spirv,
        specialized: None,
        ways: report::Ways::Declared,
        weights: Weights::default(),
        rounds: None,
        time: Some(TIME),
        machine: report::Machine::default(),
    };
    let found = report::run("s.toml", &files, &Compiler::new(Options::default()), gpu, &options, &mut ());
    let found = found.map_err(|error| format!("{error:?}"))?;
    Ok(found.ways.iter().map(|way| [way.ratio.median, way.ratio.interval[0], way.ratio.interval[1]]).collect())
}
