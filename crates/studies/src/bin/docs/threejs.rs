//! The table for people who know three.js: its materials and lights, and the functions of the library that are like them.
//!
//! *In:* the rows below, and the library's catalogue. *Out:* Markdown with the error that each function's comment promises and the
//! weight of a call. *Holds:* a row names functions that there are.

use glisten_library::{Entry, FunctionEntry, entries};
use std::fmt::Write;

/// A row: what three.js calls it, the modules here, the keys of a scene, and the functions. A function is a name, or a signature where
/// there are several of one name.
type Row = (&'static str, &'static str, &'static str, &'static [&'static str]);

static ROWS: &[Row] = &[
    ("`MeshLambertMaterial`", "`lambert`", "`diffuse`", &["lambertFactor"]),
    (
        "`MeshPhongMaterial`",
        "`normalized`, with (k + 8) / 8 where three.js has (k + 2) / 8 and Schlick's Fresnel term; `blinn_phong` has no norm",
        "`specular_model = \"normalized\"`",
        &["normalizedBlinnFactor"],
    ),
    ("`MeshToonMaterial`", "`toon`", "`diffuse_model = \"toon_soft\"`", &["toonSoft"]),
    ("`MeshStandardMaterial`", "`ggx`, `fresnel`", "`base_color`, `metallic`, `roughness`", &["ggx"]),
    ("`MeshPhysicalMaterial.clearcoat`", "`clearcoat`", "`clearcoat`, `clearcoat_roughness`", &["clearcoat"]),
    (
        "`.sheen`",
        "`sheen` (Charlie)",
        "`sheen`, `sheen_roughness`; `specular_model = \"sheen\"` for fibers alone",
        &["sheenFactor", "sheen"],
    ),
    (
        "`.anisotropy`",
        "`ggx` with a tangent; `ward`",
        "`anisotropy`, `anisotropy_rotation`",
        &["ggxFactor(vec3,vec3,vec3,vec3,vec2)", "ggxBrushed"],
    ),
    ("`.iridescence`", "`iridescence`", "`iridescence`, `iridescence_thickness`", &["iridescenceFresnel"]),
    ("`.transmission`, thin", "`transmission`", "`transmission`, `absorption`", &["transmissionFactor"]),
    (
        "`.transmission`, `.thickness`, `.dispersion`",
        "`transmission`",
        "`refraction`, `dispersion`, `absorption`",
        &["transmissionSphere", "transmissionIndices", "transmissionLeft"],
    ),
    (
        "`.ior`, `.specularColor`, `.specularIntensity`",
        "`fresnel`",
        "`dielectric`, `dielectric_strength`",
        &["fresnelNormal", "fresnelDielectric"],
    ),
    ("a measured metal", "`fresnel`", "none", &["fresnelConductor"]),
    ("plaster, clay, cloth without gloss", "`oren_nayar`, `burley`", "`diffuse_model = \"eon\"`", &["eonFactor"]),
    ("the moon, asteroids, dark dust", "`lunar`", "none", &["lunarFactor"]),
    (
        "wax, drawings, the moon",
        "`artistic`",
        "`diffuse_model = \"wrap\"`, `\"minnaert\"`",
        &["wrapFactor", "gooch", "rimFactor"],
    ),
    (
        "`MeshSSSNodeMaterial`: skin, milk, marble",
        "`subsurface`",
        "`subsurface`, `subsurface_radius`",
        &["subsurfaceBands(vec3,vec3)", "subsurfaceFactor"],
    ),
    ("`HemisphereLight`", "`hemisphere`", "`[[light]] kind = \"hemisphere\"`", &["hemisphere"]),
    ("`LightProbe`", "`irradiance`", "`[environment] coefficients`", &["irradiance", "irradianceMirrored"]),
    (
        "`scene.environment`, `PMREMGenerator`",
        "`environment`, by `glisten lib prefilter`",
        "`[environment]`",
        &["environmentSpecular", "environmentRadiance"],
    ),
    (
        "`SpotLight.penumbra`, `.distance`",
        "`punctual`: the edge is the square of a ramp, for three.js' smoothstep",
        "`cone`, `range` of a light",
        &["punctualCone", "punctualFalloff"],
    ),
    (
        "`RectAreaLight`; disks, tubes, spheres",
        "`ltc`",
        "`[[light]] kind = \"rectangle\"`, `\"disk\"`, `\"tube\"`, `\"sphere\"`",
        &["ltcRectangle", "ltcDisk", "ltcTube", "ltcSphere"],
    ),
    ("metals that stay bright", "`energy`", "none", &["energyFactor", "energyCompensation", "energyRoughness"]),
    ("`aoMap`", "`ao`", "`occlusion_map`", &["aoSpecular", "aoBounced"]),
    ("`power`, candela", "`photometry`", "none", &["photometryPoint", "photometryLux"]),
    ("`IESSpotLight`", "`photometry`", "`profile = { ies = \"lamp.ies\" }`", &["photometryProfile"]),
    ("`MeshMatcapMaterial`", "`matcap`", "`matcap`", &["matcapCoordinate"]),
    ("`alphaHash`, dissolving", "`dissolve`", "none", &["dissolveKept", "dissolveGlow"]),
    ("`PCFShadowMap`", "`shadow`", "`map = { depths = { .. } }`", &["shadowPercentageCloser"]),
    ("PCSS, as in its example", "`shadow`", "the same", &["shadowSoftLamp", "shadowSoftSun"]),
    ("`VSMShadowMap`", "`shadow`", "the same", &["shadowVariance"]),
    ("`CSM`", "`shadow`", "none", &["shadowSplit", "shadowCascade"]),
    ("spheres by their nearest point", "`area_light`", "none", &["areaSphere", "areaSphereFactor"]),
    ("`FogExp2`", "`fog`", "none", &["fogFactorSquared"]),
    ("`normalMap`, triplanar, parallax", "`normal_map`", "`normal_map`", &["normalMapped", "triplanarWeights"]),
    ("`OutlineEffect`", "`outline`", "`program = \"edge\"`", &["outlinePosition", "outlineThinned"]),
    ("`toneMapping`", "`tonemap`", "`tonemap`, `exposure` of the framebuffer", &["tonemapNeutral"]),
    ("`ColorManagement`", "`color`, `srgb`", "`encode` of the framebuffer", &["colorToP3", "srgbEncode(vec3)"]),
    ("`SimplexNoise`", "`noise`", "none", &["noiseSimplex"]),
];

/// The table.
///
/// # Errors
/// A row names a function that there is not.
pub(crate) fn table() -> Result<String, String> {
    let entries = entries();
    let mut text =
        "| three.js | here | in a scene | in a shader | error | cost |\n| --- | --- | --- | --- | --- | ---: |\n"
            .to_owned();
    for (theirs, modules, keys, names) in ROWS {
        let functions: Vec<&FunctionEntry> = names.iter().map(|name| find(&entries, name)).collect::<Result<_, _>>()?;
        let calls: Vec<String> = functions.iter().map(|function| format!("`{}()`", function.name)).collect();
        let costs: Vec<String> = functions.iter().map(|function| function.cost.weight().to_string()).collect();
        let error = functions.iter().filter_map(|function| bound(function)).max_by(|a, b| a.0.total_cmp(&b.0));
        let error = error.map_or("0", |(_, text)| text);
        let _ =
            writeln!(text, "| {theirs} | {modules} | {keys} | {} | {error} | {} |", calls.join(", "), costs.join(", "));
    }
    Ok(text)
}

fn find<'e>(entries: &'e [Entry], name: &str) -> Result<&'e FunctionEntry, String> {
    let mut functions = entries.iter().flat_map(|entry| &entry.functions);
    let found = functions.find(|function| function.name == name || function.signature == name);
    found.ok_or_else(|| format!("the library has no function `{name}`"))
}

/// The error that a comment promises, as a number and as it is written.
fn bound(function: &FunctionEntry) -> Option<(f64, &str)> {
    let text = function.bound.as_deref()?.split_whitespace().next()?;
    Some((text.parse().ok()?, text))
}
