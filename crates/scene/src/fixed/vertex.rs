//! The vertex stage of the fixed-function pipeline as GLSL: transformation, lighting, texture coordinates, fog
//! coordinate, point size (OpenGL 2.1 §2.11 to §2.14, §3.3).
//!
//! *In:* a [`Pipeline`]. *Out:* the text. *Holds:* what a switch leaves out is not in the text.

use super::pipeline::{ColorMaterial, FogSource, NormalScaling, Pipeline, TexGen};

impl Pipeline {
    /// The vertex stage as GLSL.
    pub fn vertex(&self) -> String {
        write(self)
    }
}

fn write(pipeline: &Pipeline) -> String {
    let mut text = String::from(pipeline.version());
    text.push_str("// The vertex stage of OpenGL's fixed-function pipeline.\n");
    if pipeline.enabled_units().next().is_some() {
        text.push_str(&pipeline.texture_coordinate_declaration("out"));
    }
    if pipeline.lighting {
        lighting_functions(pipeline, &mut text);
    }
    text.push_str("\nvoid main()\n{\n    gl_Position = ftransform();\n");
    if needs_eye(pipeline) {
        text.push_str("    vec4 eye = gl_ModelViewMatrix * gl_Vertex;\n");
    }
    if needs_normal(pipeline) {
        text.push_str("    vec3 normal = gl_NormalMatrix * gl_Normal;\n");
        text.push_str(match pipeline.normals {
            NormalScaling::None => "",
            NormalScaling::Rescale => "    normal *= gl_NormalScale;\n",
            NormalScaling::Normalize => "    normal = normalize(normal);\n",
        });
    }
    colors(pipeline, &mut text);
    texture_coordinates(pipeline, &mut text);
    if pipeline.fog.is_some() {
        let coordinate = match pipeline.fog_source {
            FogSource::Depth => "abs(eye.z / eye.w)",
            FogSource::Coordinate => "gl_FogCoord",
        };
        text.push_str(&format!("    gl_FogFragCoord = {coordinate};\n"));
    }
    if pipeline.point_attenuation {
        text.push_str(POINT_SIZE);
    }
    if pipeline.clip {
        text.push_str("    gl_ClipVertex = eye;\n");
    }
    text.push_str("}\n");
    text
}

const POINT_SIZE: &str = "    float distance = length(eye.xyz / eye.w);
    float attenuation = gl_Point.distanceConstantAttenuation
        + (gl_Point.distanceLinearAttenuation + gl_Point.distanceQuadraticAttenuation * distance) * distance;
    gl_PointSize = clamp(gl_Point.size * inversesqrt(attenuation), gl_Point.sizeMin, gl_Point.sizeMax);
";

fn generates(pipeline: &Pipeline, kinds: &[TexGen]) -> bool {
    pipeline.enabled_units().filter_map(|(_, unit)| unit.generate).any(|kind| kinds.contains(&kind))
}

fn needs_eye(pipeline: &Pipeline) -> bool {
    let fog = pipeline.fog.is_some() && pipeline.fog_source == FogSource::Depth;
    let generated = [TexGen::EyeLinear, TexGen::SphereMap, TexGen::ReflectionMap];
    pipeline.lighting || pipeline.point_attenuation || pipeline.clip || fog || generates(pipeline, &generated)
}

fn needs_normal(pipeline: &Pipeline) -> bool {
    pipeline.lighting || generates(pipeline, &[TexGen::SphereMap, TexGen::ReflectionMap, TexGen::NormalMap])
}

/// The primary and secondary colors of each side.
fn colors(pipeline: &Pipeline, text: &mut String) {
    if !pipeline.lighting {
        text.push_str("    gl_FrontColor = gl_Color;\n");
        if pipeline.two_side {
            text.push_str("    gl_BackColor = gl_Color;\n");
        }
        if pipeline.color_sum {
            text.push_str("    gl_FrontSecondaryColor = gl_SecondaryColor;\n");
            if pipeline.two_side {
                text.push_str("    gl_BackSecondaryColor = gl_SecondaryColor;\n");
            }
        }
        return;
    }
    let sides: &[(&str, &str)] =
        if pipeline.two_side { &[("Front", "normal"), ("Back", "-normal")] } else { &[("Front", "normal")] };
    for (side, normal) in sides {
        let lower = side.to_lowercase();
        text.push_str(&format!(
            "\n    vec4 {lower} = {};\n    vec4 {lower}_specular = vec4(0.0);\n",
            scene(pipeline, side)
        ));
        for (index, _) in pipeline.lights.iter().enumerate().filter(|(_, on)| **on) {
            let products = products(pipeline, side, index);
            text.push_str(&format!(
                "    light({index}, {products}, gl_{side}Material.shininess, eye, {normal}, {lower}, {lower}_specular);\n"
            ));
        }
        let alpha = match pipeline.color_material {
            Some(ColorMaterial::Diffuse | ColorMaterial::AmbientAndDiffuse) => "gl_Color.a".to_owned(),
            _ => format!("gl_{side}Material.diffuse.a"),
        };
        let sum = if pipeline.separate_specular { "" } else { &format!(" + {lower}_specular.rgb") };
        text.push_str(&format!("    gl_{side}Color = vec4({lower}.rgb{sum}, {alpha});\n"));
        if pipeline.sums_colors() {
            let specular =
                if pipeline.separate_specular { format!("{lower}_specular.rgb") } else { "vec3(0.0)".to_owned() };
            // "The alpha component of c_sec is always 1" (OpenGL 2.1 §2.14.1).
            text.push_str(&format!("    gl_{side}SecondaryColor = vec4({specular}, 1.0);\n"));
        }
    }
}

/// The light that belongs to no source (§2.14.1).
fn scene(pipeline: &Pipeline, side: &str) -> String {
    match pipeline.color_material {
        Some(ColorMaterial::Ambient | ColorMaterial::AmbientAndDiffuse) => {
            format!("gl_{side}Material.emission + gl_Color * gl_LightModel.ambient")
        }
        Some(ColorMaterial::Emission) => {
            format!("gl_Color + gl_{side}Material.ambient * gl_LightModel.ambient")
        }
        _ => format!("gl_{side}LightModelProduct.sceneColor"),
    }
}

/// The products of a light with the ambient, diffuse and specular colors of the material.
fn products(pipeline: &Pipeline, side: &str, index: usize) -> String {
    let from_vertex = |member: &str| {
        matches!(
            (pipeline.color_material, member),
            (Some(ColorMaterial::AmbientAndDiffuse), "ambient" | "diffuse")
                | (Some(ColorMaterial::Ambient), "ambient")
                | (Some(ColorMaterial::Diffuse), "diffuse")
                | (Some(ColorMaterial::Specular), "specular")
        )
    };
    let product = |member: &str| {
        if from_vertex(member) {
            format!("gl_Color * gl_LightSource[{index}].{member}")
        } else {
            format!("gl_{side}LightProduct[{index}].{member}")
        }
    };
    ["ambient", "diffuse", "specular"].map(product).join(", ")
}

/// `light`: adds what one source contributes (OpenGL 2.1 §2.14.1).
fn lighting_functions(pipeline: &Pipeline, text: &mut String) {
    let half = if pipeline.local_viewer {
        "        // The viewer is at the origin of eye space.
        vec3 half_vector = normalize(towards - normalize(vertex));
"
    } else {
        "        // The viewer is at infinity, along the z axis.
        vec3 half_vector = normalize(towards + vec3(0.0, 0.0, 1.0));
"
    };
    text.push_str(LIGHT_START);
    text.push_str(half);
    text.push_str(LIGHT_END);
}

const LIGHT_START: &str = "
// Adds the light of a source: ambient and diffuse to `color`, specular to `highlight`.
void light(int source, vec4 ambient, vec4 diffuse, vec4 specular, float shininess, vec4 eye, vec3 normal,
           inout vec4 color, inout vec4 highlight)
{
    vec3 vertex = eye.xyz / eye.w;
    vec4 position = gl_LightSource[source].position;
    float factor = 1.0;
    vec3 towards;
    if (position.w == 0.0) {
        towards = normalize(position.xyz);
    } else {
        vec3 path = position.xyz / position.w - vertex;
        float distance = length(path);
        towards = path / distance;
        factor = 1.0 / (gl_LightSource[source].constantAttenuation
            + (gl_LightSource[source].linearAttenuation
                + gl_LightSource[source].quadraticAttenuation * distance) * distance);
    }
    if (gl_LightSource[source].spotCutoff != 180.0) {
        float cosine = dot(-towards, normalize(gl_LightSource[source].spotDirection));
        float exponent = gl_LightSource[source].spotExponent;
        if (cosine < gl_LightSource[source].spotCosCutoff)
            factor = 0.0;
        else if (exponent != 0.0)
            factor *= pow(max(cosine, 0.0), exponent);
    }
    color += factor * ambient;
    float lambert = dot(normal, towards);
    if (lambert > 0.0) {
        color += factor * lambert * diffuse;
";

const LIGHT_END: &str = "        float blinn = max(dot(normal, half_vector), 0.0);
        // 0 to the power of 0 is 1.
        float power = shininess == 0.0 ? 1.0 : blinn > 0.0 ? pow(blinn, shininess) : 0.0;
        highlight += factor * power * specular;
    }
}
";

/// The coordinates of each unit: those of the vertex or generated ones, by the unit's matrix (§2.11.2, §2.11.4).
fn texture_coordinates(pipeline: &Pipeline, text: &mut String) {
    for (index, unit) in pipeline.enabled_units() {
        text.push_str(&format!("\n    vec4 coordinate{index} = gl_MultiTexCoord{index};\n"));
        if let Some(kind) = unit.generate {
            generated(index, kind, text);
        }
        text.push_str(&format!("    gl_TexCoord[{index}] = gl_TextureMatrix[{index}] * coordinate{index};\n"));
    }
}

fn generated(index: usize, kind: TexGen, text: &mut String) {
    let name = format!("coordinate{index}");
    let planes = |from: &str, what: &str| {
        let dot = |axis: &str| format!("dot({from}, gl_{what}Plane{axis}[{index}])");
        format!("    {name} = vec4({});\n", ["S", "T", "R", "Q"].map(dot).join(", "))
    };
    let reflected = format!(
        "    vec3 view{index} = normalize(eye.xyz / eye.w);\n    vec3 reflected{index} = reflect(view{index}, normal);\n"
    );
    text.push_str(&match kind {
        TexGen::ObjectLinear => planes("gl_Vertex", "Object"),
        TexGen::EyeLinear => planes("eye", "Eye"),
        TexGen::SphereMap => format!(
            "{reflected}    {name}.st = reflected{index}.xy / (2.0 * length(reflected{index} + vec3(0.0, 0.0, 1.0))) + \
             0.5;\n"
        ),
        TexGen::ReflectionMap => format!("{reflected}    {name}.stp = reflected{index};\n"),
        TexGen::NormalMap => format!("    {name}.stp = normal;\n"),
    });
}
