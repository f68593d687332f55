//! Compares formulas that are no color: where an outline stands, and the curves of figure 127.

use super::Used;
use super::facts::{matrix, uniform, vertices};
use super::points::{RIM, alone};
use super::sample::Sample;
use super::tex::{Definition, Value, Values};
use glam::{DVec2, DVec3};
use glisten::scene::Scene;
use glisten_reference::{RenderOptions, render};
use glisten_verify::scene::{AttributeValues, Primitive};

/// The pixels in which the vertices of an outline stand.
pub(super) fn compare_outline(
    scene: &Scene,
    draw: usize,
    printed: &[Definition],
    used: &Used,
) -> Result<usize, String> {
    // Wide, so that the ratio of the sides matters.
    let mut samples = 0;
    for (width, height) in [(320, 320), (640, 240)] {
        let mut scene = alone(scene, draw);
        let stretch = f64::from(height) / f64::from(width);
        widen(&mut scene, stretch);
        (scene.framebuffer.width, scene.framebuffer.height) = (width, height);
        samples += outline(&scene, stretch, printed, used)?;
    }
    Ok(samples)
}

/// Makes the matrices of a scene those of a wider picture.
fn widen(scene: &mut Scene, stretch: f64) {
    let draw = &mut scene.draws[0];
    for name in ["model_view_projection", "projection"] {
        let leaf = draw.program.interface.uniforms.iter().find(|leaf| leaf.name == name).expect("it is declared");
        let start = leaf.flat_offset as usize;
        for column in 0..4 {
            let value = &mut draw.uniforms[leaf.root.0 as usize][start + 4 * column];
            if let glisten_front::hir::ScalarValue::Float(value) = value {
                *value = (f64::from(*value) * stretch) as f32;
            }
        }
    }
}

fn outline(scene: &Scene, stretch: f64, printed: &[Definition], used: &Used) -> Result<usize, String> {
    let mut points = scene.clone();
    let all = vertices(&scene.draws[0]);
    let draw = &mut points.draws[0];
    draw.state.primitive = Primitive::Points;
    (draw.indices, draw.vertex_count) = (None, all.len() as u32);
    let picture = render(&points, &RenderOptions::default()).map_err(|errors| errors[0].message.clone())?;
    let draw = &scene.draws[0];
    let clip = matrix(draw, "model_view_projection").expect("a matrix");
    let index = draw.program.interface.attributes.iter().position(|one| one.name == "normal").expect("normals");
    let Some(AttributeValues::Float(normals)) = draw.attributes[index].as_ref().map(|data| &data.values) else {
        return Err("no normals".to_owned());
    };
    let (width, height) = (picture.width as usize, picture.height as usize);
    let mut samples = 0;
    for (vertex, normal) in all.iter().zip(normals.chunks(3)) {
        let normal = DVec3::new(f64::from(normal[0]), f64::from(normal[1]), f64::from(normal[2]));
        let along = clip * normal.extend(0.0);
        // The derivative of x/w and y/w along the normal, except for its length.
        let n = along.truncate().truncate() * vertex.clip.w - vertex.clip.truncate().truncate() * along.w;
        let more = |name: &str| match name {
            "p" => Some(Value::Vector([vertex.clip.x, vertex.clip.y, 0.0])),
            "p_w" => Some(Value::Number(vertex.clip.w)),
            "n" => Some(Value::Vector([n.x, n.y, 0.0])),
            "n_x" => Some(Value::Number(n.x)),
            "n_y" => Some(Value::Number(n.y)),
            "a" => Some(Value::Number(1.0 / stretch)),
            "b" => uniform(draw, "width").map(|width| Value::Number(width[0])),
            _ => None,
        };
        let sample = Sample::new(draw, (printed, used), (DVec3::ZERO, DVec3::Z), &more);
        let Value::Vector(rim) = sample.symbol("p_rim")? else { return Err("`p_rim` is a number".to_owned()) };
        let at = DVec2::new(rim[0], rim[1]) / vertex.clip.w;
        let (x, y) = (0.5 * (at.x + 1.0) * width as f64, 0.5 * (1.0 - at.y) * height as f64);
        if [x, y].iter().any(|at| (at - at.round()).abs() < RIM) || n.length() < 1e-3 {
            continue;
        }
        if !picture.covered[y as usize * width + x as usize] {
            return Err(format!("no vertex of the outline at ({x:.2}, {y:.2})"));
        }
        samples += 1;
    }
    Ok(samples)
}

/// The curves: at each abscissa the picture has the ink of a curve where its formula says, and none far from it.
pub(super) fn compare_curves(scene: &Scene, printed: &[Definition], used: &Used) -> Result<usize, String> {
    let draw = &scene.draws[0];
    let picture = render(scene, &RenderOptions::default()).map_err(|errors| errors[0].message.clone())?;
    let exponents = uniform(draw, "exponents").ok_or("no exponents")?;
    let (width, height) = (picture.width as usize, picture.height as usize);
    let ink = |name: &str| uniform(draw, name).ok_or(format!("no {name}"));
    let (cosine, normal) = (ink("cosine_color")?, ink("normal_color")?);
    let mut samples = 0;
    for column in (width / 20..width - width / 20).step_by(3) {
        // The picture is from -90 to 90 degrees wide, and from `below` to `above` high.
        let theta = ((column as f64 + 0.5) / width as f64 - 0.5) * std::f64::consts::PI;
        for &exponent in &exponents {
            for (name, color) in [("y_1", &cosine), ("y_2", &normal)] {
                let more = |symbol: &str| match symbol {
                    "theta" => Some(Value::Number(theta)),
                    "cos theta" => Some(Value::Number(theta.cos())),
                    "n" => Some(Value::Number(exponent)),
                    "e" => Some(Value::Number(std::f64::consts::E)),
                    _ => None,
                };
                let sample = Sample::new(draw, (printed, used), (DVec3::ZERO, DVec3::Z), &more);
                let Value::Number(y) = sample.symbol(name)? else { return Err(format!("`{name}` is no number")) };
                let (low, high) =
                    (uniform(draw, "below").ok_or("no below")?[0], uniform(draw, "above").ok_or("no above")?[0]);
                let row = (1.0 - (y - low) / (high - low)) * height as f64;
                if !(1.0..height as f64 - 1.0).contains(&row) {
                    return Err(format!("{name} leaves the picture"));
                }
                let pixel = picture.attachments[0][row as usize * width + column];
                let other = if name == "y_1" { &normal } else { &cosine };
                let off = |ink: &[f64]| (0..3).map(|i| (pixel[i] - ink[i]).abs()).fold(0.0, f64::max);
                // Where the curves lie on each other, the later one is seen.
                if off(color).min(off(other)) > 0.35 {
                    return Err(format!("no ink of {name} for n = {exponent} at {theta:.3}: {pixel:.2?}"));
                }
                samples += 1;
            }
        }
    }
    Ok(samples)
}
