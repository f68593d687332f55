//! [`meaning`]: what a number of a uniform means, by the words of its name.
//!
//! *In:* the name of a uniform, its members included, and its type. *Out:* a [`Meaning`]. *Holds:* the first row of the table that fits
//! decides; a row fits if the name contains a word of each of its lists, and none of the last one.

use glisten_front::hir::{Scalar, Type};

/// The meaning of the numbers of a uniform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Meaning {
    /// The size of the window in pixels.
    Resolution,
    /// The size of a pixel, where the window is 1.
    Texel,
    Time,
    Frame,
    Mouse,
    LightPosition,
    /// Towards the light.
    LightDirection,
    /// Along the beam.
    SpotDirection,
    Eye,
    Up,
    Right,
    /// Along the view.
    Forward,
    /// A color with this in all components, and 1 in a fourth one.
    Color(f64),
    BaseColor,
    FogColor,
    /// The strength of a light, which falls off with the distance or not.
    Power,
    /// The least and the greatest value; of three components, also the one between.
    Range(f64, f64),
    /// A number of elements, samples or steps.
    Count,
    /// Points of a kernel.
    Samples,
    /// Weights whose sum is 1.
    Weights,
    /// This in all components.
    Value(f64),
    Switch(bool),
    /// The least and the greatest coordinates of most of the window.
    Rectangle,
    /// The planes `[0, 1, 0, 0]`.
    Plane,
    Unknown,
}

use Meaning::{
    BaseColor, Color, Count, Eye, FogColor, Forward, Frame, LightDirection, LightPosition, Mouse, Plane, Power, Range,
    Rectangle, Resolution, Right, Samples, SpotDirection, Switch, Texel, Time, Up, Value, Weights,
};

/// Words, one of which a name contains.
type Words = &'static [&'static str];

/// A row: lists of which a name contains a word each, words that it contains none of, and the meaning.
type Row = (&'static [Words], Words, Meaning);

/// The planes of the camera.
pub(super) const NEAR: f64 = 0.5;
pub(super) const FAR: f64 = 20.0;

const LIGHTS: Words = &["light", "sun", "lamp", "spot", "lpos", "moon"];

/// The meanings of floats and vectors.
static FLOATS: &[Row] = &[
    (&[&["time", "seconds", "elapsed", "clock", "animation"]], &["step", "scale", "delta", "lifetime", "day"], Time),
    // Weather, and what befalls a player's eyes.
    (
        &[&["darkness", "blindness", "nightvision", "rain", "wetness", "snow"]],
        &["color", "colour", "train"],
        Value(0.0),
    ),
    (&[&["scissor", "rect", "bounds", "region", "crop", "vignette"]], &["direct"], Rectangle),
    (&[&["deltatime", "timedelta", "frametime", "timestep", "dt"]], &["width"], Value(0.016)),
    (&[&["mouse", "cursor", "touch"]], &[], Mouse),
    (&[&["near"], &["far"]], &["color"], Range(NEAR, FAR)),
    (&[&["min"], &["max"]], &["lumin"], Range(0.0, 1.0)),
    (&[&["enable"]], &[], Value(1.0)),
    (&[&["attenuation"]], &["range", "scale", "radius", "light"], Color(0.2)),
    (&[&["constant"]], &["color", "alpha"], Value(1.0)),
    (&[&["quadratic"]], &[], Value(0.02)),
    (&[LIGHTS, &["linear"]], &[], Value(0.05)),
    (&[&["linear"]], &["depth"], Value(0.05)),
    (&[&["outercutoff", "cosouter", "outercone", "outerangle"]], &[], Value(0.8)),
    (&[&["cutoff", "innercone", "innerangle", "coscone", "conecos"]], &["freq"], Value(0.9)),
    (&[LIGHTS, &["power", "intensity", "brightness"]], &["exp", "ambient"], Power),
    (&[LIGHTS, &["amb"]], &["pos", "dir", "lambert"], Color(0.2)),
    (
        &[LIGHTS, &["color", "colour", "diff", "spec", "radiance", "intensity", "col", "rgb"]],
        &["pos", "dir", "differ"],
        Color(1.0),
    ),
    (&[&["spotdir", "conedir", "lighttarget", "spot_dir"]], &[], SpotDirection),
    (&[LIGHTS, &["dir", "vec", "normal", "towards"]], &["view"], LightDirection),
    (&[LIGHTS, &["pos", "loc", "point", "origin", "world", "eye"]], &["size", "color", "matrix"], LightPosition),
    (&[&["lightradius", "lightrange", "lightsize"]], &[], Value(10.0)),
    (&[&["fogcolor", "fogcolour", "fog_color"]], &[], FogColor),
    (&[&["fog"], &["start", "near", "begin", "min"]], &[], Value(1.0)),
    (&[&["fog"], &["end", "far", "max"]], &[], Value(8.0)),
    (&[&["fog"], &["dens"]], &[], Value(0.1)),
    (
        &[&[
            "texel",
            "onepixel",
            "pixelsize",
            "invres",
            "rcp",
            "invsize",
            "invtex",
            "invview",
            "invscreen",
            "halfpixel",
            "texeloffset",
            "texstep",
            "pixelstep",
            "sizeinverse",
            "rt_metrics",
        ]],
        &["count"],
        Texel,
    ),
    (
        &[&[
            "resolution",
            "viewport",
            "screensize",
            "screen_size",
            "windowsize",
            "window_size",
            "texturesize",
            "texsize",
            "texsz",
            "inputsize",
            "outputsize",
            "insize",
            "outsize",
            "imagesize",
            "framebuffersize",
            "fbsize",
            "rendersize",
            "viewsize",
            "dimension",
            "screenwidth",
            "screenheight",
            "windowwidth",
            "windowheight",
            "screendim",
            "originalsize",
            "sourcesize",
            "finalviewport",
            "viewwidth",
            "viewheight",
            "texwidth",
            "texheight",
            "imagewidth",
            "imageheight",
            "renderwidth",
            "renderheight",
            "pixelcount",
        ]],
        &["scale", "inv"],
        Resolution,
    ),
    (&[&["aspect"]], &[], Value(1.0)),
    (&[&["near", "znear"]], &["color"], Value(NEAR)),
    (&[&["far", "zfar"]], &["color", "corner"], Value(FAR)),
    (&[&["fov"]], &[], Value(0.785)),
    (&[&["camera", "eye", "view", "cam"], &["pos", "loc", "origin", "point"]], &["light"], Eye),
    (&[&["camera", "eye", "view", "cam"], &["up"]], &["light"], Up),
    (&[&["camera", "eye", "view", "cam"], &["right", "side"]], &["light"], Right),
    (&[&["camera", "eye", "view", "cam", "look"], &["dir", "forward", "front", "vec"]], &["light"], Forward),
    (&[&["camera", "eye"]], &["light", "dist"], Eye),
    (
        &[&[
            "shin",
            "glossiness",
            "hardness",
            "specularpower",
            "specpower",
            "specularexponent",
            "specexp",
            "phongexp",
            "exponent",
        ]],
        &["texture"],
        Value(32.0),
    ),
    (&[&["rough"]], &[], Value(0.4)),
    (&[&["metal"]], &[], Value(0.2)),
    (&[&["emissi", "emission"]], &["power", "intensity", "strength"], Color(0.0)),
    (&[&["gamma"]], &[], Value(2.2)),
    (
        &[&["eta", "refractiveindex", "ior", "refractionindex"]],
        &["beta", "theta", "priority", "prior", "inter"],
        Value(1.5),
    ),
    (&[&["f0", "fresnel"]], &["power", "scale"], Value(0.04)),
    (&[&["bias", "epsilon"]], &[], Value(0.005)),
    (&[&["alphatest", "alphafunc", "alpharef", "alphacut", "alphathreshold"]], &[], Value(0.1)),
    (&[&["alpha", "opacity", "transparency", "opaque"]], &[], Value(1.0)),
    (&[&["kernel", "samples", "poisson", "offsets"]], &["num", "count"], Samples),
    (&[&["weight", "gauss", "coeff"]], &[], Weights),
    (&[&["amb"]], &["occl", "lambert", "ambig"], Color(0.2)),
    (&[&["modulat", "tint", "coldiffuse", "multiply", "colormul"]], &[], Color(1.0)),
    (&[&["specular", "spec"]], &[], Color(0.5)),
    (&[&["plane"]], &["near", "far", "dist"], Plane),
    (&[&["background", "clearcolor", "bgcolor", "skycolor", "horizon", "sky"]], &[], FogColor),
    (&[&["outline", "border", "edgecolor", "shadowcolor", "linecolor"], &["col"]], &[], Color(0.1)),
    (
        &[&["color", "colour", "diff", "albedo", "tone", "rgb", "col"]],
        &["scale", "size", "count", "colli", "column", "differ"],
        BaseColor,
    ),
    (
        &[&["exposure", "saturation", "contrast", "brightness", "zoom", "scale", "tiling", "repeat", "stretch"]],
        &["depth"],
        Value(1.0),
    ),
    (
        &[&[
            "offset",
            "translat",
            "shift",
            "scroll",
            "displacement",
            "jitter",
            "rotation",
            "angle",
            "velocity",
            "wind",
            "bump",
            "lod",
            "hue",
            "origin",
            "delta",
        ]],
        &["texel"],
        Value(0.0),
    ),
    (
        &[&[
            "center",
            "centre",
            "focus",
            "threshold",
            "level",
            "mid",
            "progress",
            "mix",
            "blend",
            "fade",
            "ratio",
            "percent",
        ]],
        &[],
        Value(0.5),
    ),
    (&[&["freq", "octave", "wave", "cells", "bands", "lines"]], &["length", "amp", "height"], Value(4.0)),
    (&[&["amp", "height", "thick", "width", "noise", "strength"]], &["lamp", "sampl", "example", "clamp"], Value(0.2)),
    (&[&["inner"]], &["color"], Value(0.2)),
    (&[&["outer"]], &["color"], Value(0.6)),
    (&[&["size", "speed", "intensity", "factor", "power", "amount", "radius", "max"]], &[], Value(1.0)),
    (&[&["min"]], &["lumin", "dimin"], Value(0.0)),
];

/// The meanings of integers.
static INTEGERS: &[Row] = &[
    (&[&["frame"]], &["size", "count"], Frame),
    (
        &[&[
            "resolution",
            "viewport",
            "screensize",
            "windowsize",
            "texturesize",
            "screen",
            "window",
            "width",
            "height",
        ]],
        &["scale"],
        Resolution,
    ),
    (&[&["color", "colour"]], &["mode", "index", "count", "num", "id", "type"], Value(200.0)),
    (&[&["shin", "exponent"]], &[], Value(32.0)),
    (&[&["time", "seed"]], &[], Value(1.0)),
    (
        &[&[
            "num", "count", "samples", "iter", "steps", "octave", "passes", "max", "total", "lights", "size", "kernel",
            "levels", "radius", "taps", "layers", "slices", "cascades",
        ]],
        &["mode", "type", "kind"],
        Count,
    ),
    (
        &[&["has", "use", "enable", "is", "do", "with", "apply", "lit", "textured"]],
        &["mode", "noise", "disp", "dist"],
        Switch(true),
    ),
    (
        &[&[
            "index", "layer", "mode", "type", "level", "lod", "shape", "channel", "instance", "id", "pass", "debug",
            "flag",
        ]],
        &[],
        Value(0.0),
    ),
];

/// The meanings of booleans.
static BOOLEANS: &[Row] = &[
    (
        &[&[
            "no", "disable", "invert", "flip", "debug", "wire", "only", "hide", "reverse", "skip", "show", "ortho",
            "picking", "mirror", "gray", "grey", "cartoon",
        ]],
        &["normal", "noise", "specular"],
        Switch(false),
    ),
    (&[&[""]], &[], Switch(true)),
];

/// The letters of the equations of light, as names of vectors.
static SHORT: &[(&[&str], Meaning)] = &[
    (&["ka", "la"], Color(0.2)),
    (&["kd"], BaseColor),
    (&["ks"], Color(0.5)),
    (&["ke"], Color(0.0)),
    (&["ld", "ls"], Color(1.0)),
    (&["lp"], LightPosition),
];

/// The meaning of a uniform.
pub(super) fn meaning(name: &str, ty: Type) -> Meaning {
    let small: String = name.chars().filter(|letter| letter.is_alphanumeric()).collect::<String>().to_ascii_lowercase();
    let rows = match ty {
        Type::Scalar(Scalar::Bool) | Type::Vector(Scalar::Bool, _) => BOOLEANS,
        Type::Scalar(Scalar::Int | Scalar::Uint) | Type::Vector(Scalar::Int | Scalar::Uint, _) => INTEGERS,
        _ => FLOATS,
    };
    let has = |words: &Words| words.iter().any(|word| small.contains(&word.replace('_', "")));
    let fits = |(all, none, _): &&Row| all.iter().all(has) && !has(none);
    let found = rows.iter().find(fits).map(|(_, _, meaning)| *meaning);
    let is_size = match ty {
        Type::Scalar(_) => ["width", "height"].contains(&small.as_str()),
        Type::Vector(_, 2) => ["screen", "uscreen", "viewport", "window"].contains(&small.as_str()),
        _ => false,
    };
    if is_size {
        return Resolution;
    }
    let last = name.rsplit(['.', '_']).next().map(str::to_ascii_lowercase);
    let short = SHORT.iter().find(|(names, _)| names.contains(&last.as_deref().unwrap_or_default()));
    if let (Some((_, meaning)), Type::Vector(..)) = (short, ty) {
        return *meaning;
    }
    let of_member = || match (last.as_deref(), ty) {
        (Some("position" | "pos"), Type::Vector(..)) if LIGHTS.iter().any(|word| small.contains(word)) => LightPosition,
        (Some("shi" | "exp"), Type::Scalar(_)) => Value(32.0),
        _ => Meaning::Unknown,
    };
    found.unwrap_or_else(of_member)
}

#[cfg(test)]
mod tests {
    use super::{FAR, Meaning, NEAR, meaning};
    use glisten_front::hir::{Scalar, Type};

    #[test]
    fn names_of_engines_and_books_have_meanings() {
        let vector = Type::Vector(Scalar::Float, 3);
        for (names, ty, expected) in [
            (
                &["lightPos", "LightPosition_worldspace", "lights[0].position", "u_LightPos"][..],
                vector,
                Meaning::LightPosition,
            ),
            (&["lightDir", "u_lightDirection", "dirLight.direction"], vector, Meaning::LightDirection),
            (&["lightColor", "light.diffuse", "LightColor", "light[0].diff"], vector, Meaning::Color(1.0)),
            (&["light[0].amb", "lights[2].ambient", "material.amb"], vector, Meaning::Color(0.2)),
            (&["iResolution", "u_resolution", "viewportSize"], vector, Meaning::Resolution),
            (&["iTime", "u_time", "time", "osg_SimulationTime"], Type::Scalar(Scalar::Float), Meaning::Time),
            (
                &["material.shininess", "Shininess", "specularExponent", "material.shi"],
                Type::Scalar(Scalar::Float),
                Meaning::Value(32.0),
            ),
            (&["viewPos", "cameraPosition", "eye_pos"], vector, Meaning::Eye),
            (&["objectColor", "material.diffuse", "material.diff", "albedo"], vector, Meaning::BaseColor),
            (&["numLights", "sampleCount", "maxIterations"], Type::Scalar(Scalar::Int), Meaning::Count),
            (&["zNear", "near", "near_plane"], Type::Scalar(Scalar::Float), Meaning::Value(NEAR)),
            (&["nearFar"], Type::Vector(Scalar::Float, 2), Meaning::Range(NEAR, FAR)),
            (&["lightIntensity", "Light.Intensity"], Type::Scalar(Scalar::Float), Meaning::Power),
            (&["Kd", "Material.Kd"], vector, Meaning::BaseColor),
            (&["Ld", "light.Ls"], vector, Meaning::Color(1.0)),
            (&["alpha", "uOpacity"], Type::Scalar(Scalar::Float), Meaning::Value(1.0)),
            (&["useTexture", "lit"], Type::Scalar(Scalar::Bool), Meaning::Switch(true)),
        ] {
            for name in names {
                assert_eq!(meaning(name, ty), expected, "{name}");
            }
        }
    }
}
