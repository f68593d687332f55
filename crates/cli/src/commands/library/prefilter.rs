//! `glisten lib prefilter`: a panorama as what the module `environment` reads.
//!
//! *In:* a panorama, as Radiance HDR or OpenEXR. *Out:* in a folder `radiance.exr` and `split_sum.exr`, the two factors of the split sum,
//! and `irradiance.toml`, nine coefficients for a scene; on the console how far the lookups are from integrals.

use crate::arguments::args::ResultFormat;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use clap::Args;
use glisten_scene::picture::Image;
use glisten_verify::environment::{Deviation, Panorama, Prefiltered, SplitSum, coefficients, errors};
use std::fmt::Write;
use std::path::PathBuf;

/// The largest panorama.
const MAX_SIDE: u32 = 16384;
const MAX_PIXELS: u64 = 1 << 27;

/// The options of `glisten lib prefilter`.
#[derive(Args, Debug)]
pub(crate) struct PrefilterArgs {
    /// The panorama, twice as wide as high: +y is up, and its middle is +x
    #[arg(value_name = "HDR|EXR")]
    panorama: PathBuf,
    /// The folder for radiance.exr, split_sum.exr and irradiance.toml
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// The side of the map of each roughness, in texels
    #[arg(long, value_name = "TEXELS", default_value_t = 129, value_parser = clap::value_parser!(u32).range(3..=1025))]
    size: u32,
    /// The number of roughnesses, evenly from 0 to 1
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(2..=16))]
    levels: u32,
    /// The number of rays for each texel
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(16..=65536))]
    rays: u32,
    /// The format of the table of errors
    #[arg(long, value_enum, default_value_t)]
    format: ResultFormat,
}

/// Runs the command.
pub(crate) fn prefilter(args: &PrefilterArgs, console: &Console) -> Outcome {
    let name = args.panorama.display().to_string();
    let bytes = files::read(&name, &args.panorama).map_err(|error| Failure::usage(error.message))?;
    let wrong = |error: &dyn std::fmt::Display| Failure::new(Exit::Content, format!("`{name}`: {error}"));
    let image = Image::read_if(&bytes, MAX_SIDE, MAX_PIXELS, Panorama::check).map_err(|error| wrong(&error))?;
    let panorama = Panorama::new(&image).map_err(|error| wrong(&error))?;
    drop(image);
    files::make_folder(&args.output)?;
    if panorama.n_limited > 0 {
        let n = panorama.n_limited;
        console.remark(&format!("{n} pixels are negative, not finite or brighter than 65504, and are limited"));
    }
    let split = SplitSum::new().ok_or_else(|| wrong(&"the table of the split sum does not load"))?;
    let maps = Prefiltered::new(&panorama, args.size as usize, args.levels as usize, args.rays as usize);
    let coefficients = coefficients(&panorama);
    let encoded = |error: glisten_scene::picture::ImageError| wrong(&error);
    files::write(&args.output.join("radiance.exr"), &maps.exr().map_err(encoded)?)?;
    files::write(&args.output.join("split_sum.exr"), &split.exr().map_err(encoded)?)?;
    files::write(&args.output.join("irradiance.toml"), irradiance(&coefficients).as_bytes())?;
    let found = errors(&panorama, &maps, &coefficients, &split);
    console.output(&match args.format {
        ResultFormat::Human => table(&found),
        ResultFormat::Json => serde_json::to_string_pretty(&found).unwrap_or_default() + "\n",
    })?;
    let [width, height] = maps.size();
    console.remark(&format!(
        "wrote radiance.exr ({width} by {height} texels, {} roughnesses), split_sum.exr and irradiance.toml to {}",
        args.levels,
        args.output.display()
    ));
    Ok(Exit::Ok)
}

/// The coefficients as a uniform of a scene.
fn irradiance(coefficients: &[[f64; 3]; 9]) -> String {
    let mut text =
        "# For irradiance() of <glisten/irradiance.glsl>: L_00, L_1-1, L_10, L_11, L_2-2, L_2-1, L_20, L_21, L_22.\n\
                    coefficients = [\n"
            .to_owned();
    for [r, g, b] in coefficients {
        let _ = writeln!(text, "    {r:.6}, {g:.6}, {b:.6},");
    }
    text + "]\n"
}

/// The table, which is also Markdown.
fn table(found: &[Deviation]) -> String {
    let mut text = "| of | roughness | mean | most |\n| --- | ---: | ---: | ---: |\n".to_owned();
    for Deviation { of, roughness, mean, most } in found {
        let roughness = roughness.map_or_else(String::new, |roughness| roughness.to_string());
        let _ = writeln!(text, "| {of} | {roughness} | {mean:.4} | {most:.4} |");
    }
    text
}
