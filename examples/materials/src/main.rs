//! A host that switches the materials of one large shader, without a window: each material is drawn by the pipeline of the whole
//! shader first, and by that of its residual as soon as a thread has made it.
//!
//! *In:* nothing. *Out:* for each material the time until its residual is ready, the times of frames by both pipelines, and
//! the largest difference of their pictures. *Holds:* no number of a binding or an offset is in this file. Each frame is waited
//! for. A material that comes back has its pipeline at once.

#![expect(clippy::print_stdout, reason = "a program prints")]

mod gpu;
mod materials;
mod worker;

use glisten::specialize::Variants;
use glisten::{Compiler, Options, Source, Stage};
use gpu::{Gpu, Pipeline};
use materials::{MATERIALS, Material, TIME};
use std::error::Error;
use std::sync::Arc;
use std::time::{Duration, Instant};
use worker::Worker;

/// A material is drawn until it has had so many frames by its residual.
const FRAMES: usize = 30;
/// 8 bits of a channel may differ by so much.
const TOLERANCE: u8 = 2;

/// The frames of a material.
#[derive(Default)]
struct Frames {
    whole: Vec<Duration>,
    residual: Vec<Duration>,
    ready: Option<Duration>,
    difference: u8,
}

fn main() -> Result<(), Box<dyn Error>> {
    let gpu = Arc::new(pollster::block_on(Gpu::new())?);
    let variants = Arc::new(Variants::new(program()?));
    let whole = gpu.pipeline_of_program(variants.program())?;
    let worker = Worker::new(Arc::clone(&gpu), Arc::clone(&variants));
    println!(
        "{:12} {:>10} {:>18} {:>18} {:>11}",
        "material", "ready, ms", "whole shader, ms", "residual, ms", "difference"
    );
    for round in 0..2 {
        for material in MATERIALS {
            let frames = show(&gpu, &whole, &worker, material)?;
            report(material, &frames);
            if frames.difference > TOLERANCE {
                return Err(format!("`{}` looks different by its residual", material.name).into());
            }
            if round > 0 && !frames.whole.is_empty() {
                return Err(format!("`{}` was forgotten", material.name).into());
            }
        }
    }
    println!("{} materials, {} residuals", MATERIALS.len(), variants.len());
    Ok(())
}

fn program() -> Result<glisten::Program, Box<dyn Error>> {
    let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
    let sources = [
        source("material.vert", include_str!("../shaders/material.vert"), Stage::Vertex),
        source("material.frag", include_str!("../shaders/material.frag"), Stage::Fragment),
    ];
    let compiled = Compiler::new(Options::default()).compile(&sources);
    let problem = compiled.diagnostics.iter().find(|found| found.is_error()).map(|found| found.message.clone());
    compiled.program.ok_or_else(|| problem.unwrap_or_else(|| "no program".into()).into())
}

/// Draws a material until its residual has had its frames.
fn show(gpu: &Gpu, whole: &Pipeline, worker: &Worker, material: &Material) -> Result<Frames, Box<dyn Error>> {
    let mut frames = Frames::default();
    let start = Instant::now();
    let mut residual: Option<Arc<Pipeline>> = worker.ready(material)?;
    while frames.residual.len() < FRAMES {
        let time = frames.whole.len() as f32 * 0.01 + frames.residual.len() as f32 * 0.01;
        let pipeline = residual.as_deref().unwrap_or(whole);
        let begun = Instant::now();
        gpu.draw(pipeline, material, time)?;
        let taken = begun.elapsed();
        match &residual {
            Some(_) => frames.residual.push(taken),
            None => {
                frames.whole.push(taken);
                residual = worker.ready(material)?;
            }
        }
        if residual.is_some() && frames.ready.is_none() {
            frames.ready = Some(start.elapsed());
        }
    }
    if let Some(residual) = &residual {
        let [by_whole, by_residual] = [whole, residual].map(|pipeline| {
            gpu.draw(pipeline, material, TIME)?;
            gpu.read()
        });
        let (by_whole, by_residual) = (by_whole?, by_residual?);
        let pairs = by_whole.iter().zip(&by_residual);
        frames.difference = pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
    }
    Ok(frames)
}

fn report(material: &Material, frames: &Frames) {
    let median = |times: &[Duration]| {
        let mut times = times.to_vec();
        times.sort_unstable();
        let middle = times.get(times.len() / 2);
        middle.map_or_else(|| "none".into(), |time| format!("{:.3} ({} frames)", time.as_secs_f64() * 1e3, times.len()))
    };
    let ready = frames.ready.map_or(0.0, |ready| ready.as_secs_f64() * 1e3);
    let difference = format!("{}/255", frames.difference);
    println!(
        "{:12} {ready:>10.1} {:>18} {:>18} {difference:>11}",
        material.name,
        median(&frames.whole),
        median(&frames.residual)
    );
}
