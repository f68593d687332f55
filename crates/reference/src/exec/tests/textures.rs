//! Texture functions on small textures with known answers.

use super::text::{compiled, output, ran};
use crate::domain::{Envelope, F64, Number};
use glisten_front::hir::{SamplerDim, SamplerType, Scalar};
use glisten_scene::picture::Interval;
use glisten_scene::{Compare, Filter, Texels, Texture, TextureLevel, Wrap};
use std::sync::Arc;

/// Texel k of a level holds (k, 10 + k, level, 1).
fn texture(dim: SamplerDim, arrayed: bool, sizes: &[[u32; 3]]) -> Texture {
    let levels = sizes.iter().enumerate().map(|(number, size)| {
        let count = size[0] * size[1] * size[2];
        let texels = (0..count).map(|k| [k as f32, 10.0 + k as f32, number as f32, 1.0]).collect();
        TextureLevel { width: size[0], height: size[1], depth: size[2], texels: Texels::Float(texels) }
    });
    Texture {
        kind: SamplerType { texel: Scalar::Float, dim, arrayed, shadow: false },
        levels: levels.collect(),
        filter: Filter::Nearest,
        wrap: Wrap::Repeat,
        compare: Compare::Lequal,
        sampling: glisten_scene::Sampling::default(),
    }
}

fn look(declaration: &str, expression: &str, texture: Texture) -> [f64; 4] {
    let program = compiled(&format!("uniform {declaration} t; in float a; void main() {{ o = vec4({expression}); }}"));
    let machine = ran::<F64>(&program, &[Some(Arc::new(texture))], |_, lane| lane as f64);
    output(&program, &machine)[0].map(Number::value)
}

fn plane(filter: Filter, wrap: Wrap) -> Texture {
    Texture { filter, wrap, ..texture(SamplerDim::D2, false, &[[4, 2, 1]]) }
}

#[test]
fn nearest_by_wrap_mode() {
    let x = |wrap, s: &str| look("sampler2D", &format!("texture(t, vec2({s}, 0.25))"), plane(Filter::Nearest, wrap))[0];
    for (s, repeat, clamp, mirror) in
        [("0.3", 1.0, 1.0, 1.0), ("1.1", 0.0, 3.0, 3.0), ("-0.1", 3.0, 0.0, 0.0), ("2.6", 2.0, 3.0, 2.0)]
    {
        assert_eq!(x(Wrap::Repeat, s), repeat, "{s}");
        assert_eq!(x(Wrap::ClampToEdge, s), clamp, "{s}");
        assert_eq!(x(Wrap::MirroredRepeat, s), mirror, "{s}");
    }
}

#[test]
fn linear_weighs_four_texels() {
    // Halfway between columns 1 and 2 and a quarter up from row 0's center.
    let found = look("sampler2D", "texture(t, vec2(0.5, 0.375))", plane(Filter::Linear, Wrap::ClampToEdge));
    assert_eq!(found, [2.5, 12.5, 0.0, 1.0]);
    let wrapped = look("sampler2D", "texture(t, vec2(0.0, 0.25))", plane(Filter::Linear, Wrap::Repeat));
    assert_eq!(wrapped[0], 1.5, "columns 3 and 0");
}

#[test]
fn offsets_projection_and_fetches() {
    let nearest = || plane(Filter::Nearest, Wrap::Repeat);
    assert_eq!(look("sampler2D", "textureOffset(t, vec2(0.1, 0.25), ivec2(2, 1))", nearest())[0], 6.0);
    assert_eq!(look("sampler2D", "textureProj(t, vec3(0.6, 0.5, 2.0))", nearest())[0], 1.0);
    assert_eq!(look("sampler2D", "textureProj(t, vec4(0.6, 0.5, 9.0, 2.0))", nearest())[0], 1.0);
    assert_eq!(look("sampler2D", "texelFetch(t, ivec2(3, 1), 0)", nearest())[0], 7.0);
    assert_eq!(look("sampler2D", "texelFetch(t, ivec2(4, 1), 0)", nearest()), [0.0; 4]);
    assert_eq!(look("sampler2D", "textureSize(t, 0), 0.0, 0.0", nearest()), [4.0, 2.0, 0.0, 0.0]);
    assert_eq!(look("sampler2D", "texture(t, vec2(0.0 / 0.0, 0.25))", nearest())[0], 0.0);
}

/// One lookup for all lanes, texels without intervals, and a lookup per lane.
#[test]
fn each_way_of_a_fetch_reads_the_same_texels() {
    let in_lanes =
        "uniform sampler2D t; in float a; void main() { o = texelFetch(t, ivec2(int(a) % 5, int(a) / 32), 0); }";
    let program = compiled(in_lanes);
    let textures = [Some(Arc::new(plane(Filter::Nearest, Wrap::Repeat)))];
    let plain = output(&program, &ran::<F64>(&program, &textures, |_, lane| lane as f64));
    let bounded = output(&program, &ran::<Envelope>(&program, &textures, |_, lane| lane as f64));
    for (lane, (plain, bounded)) in plain.into_iter().zip(bounded).enumerate() {
        let (x, y) = (lane % 5, lane / 32);
        // The fifth column is outside.
        let texel = 4.0 * y as f64 + x as f64;
        let expected = if x < 4 { [texel, 10.0 + texel, 0.0, 1.0] } else { [0.0; 4] };
        assert_eq!(plain, expected, "lane {lane}");
        assert_eq!(bounded.map(|number| number.value()), expected, "lane {lane}");
        assert!(bounded.iter().all(|number| number.interval().width() == 0.0), "lane {lane}: {bounded:?}");
        let once = format!("uniform sampler2D t; void main() {{ o = texelFetch(t, ivec2({x}, {y}), 0); }}");
        let program = compiled(&once);
        assert_eq!(output(&program, &ran::<F64>(&program, &textures, |_, _| 0.0))[lane], expected);
    }
}

#[test]
fn levels_of_detail() {
    let chain =
        || Texture { filter: Filter::Trilinear, ..texture(SamplerDim::D2, false, &[[4, 4, 1], [2, 2, 1], [1, 1, 1]]) };
    assert_eq!(look("sampler2D", "textureLod(t, vec2(0.5), 1.0)", chain())[2], 1.0);
    assert_eq!(look("sampler2D", "textureLod(t, vec2(0.5), 0.25)", chain())[2], 0.25);
    assert_eq!(look("sampler2D", "textureLod(t, vec2(0.5), 9.0)", chain())[2], 2.0);
    assert_eq!(look("sampler2D", "textureGrad(t, vec2(0.5), vec2(0.5, 0.0), vec2(0.0))", chain())[2], 1.0);
    // a changes by 1 from lane to lane in x and by 2 in y.
    let by_quad = "texture(t, vec2(a * 0.25, 0.5))";
    assert_eq!(look("sampler2D", by_quad, chain())[2], 1.0);
    assert_eq!(look("sampler2D", "texture(t, vec2(a * 0.25, 0.5), -0.5)", chain())[2], 0.5);
    assert_eq!(look("sampler2D", "textureSize(t, 1), 0.0, 0.0", chain())[0], 2.0);
}

#[test]
fn every_kind_finds_its_texel() {
    use SamplerDim::{Buffer, Cube, D1, D3, Rect};
    let nearest = |dim, arrayed, size| texture(dim, arrayed, &[size]);
    assert_eq!(look("sampler1D", "texture(t, 0.7)", nearest(D1, false, [4, 1, 1]))[0], 2.0);
    assert_eq!(look("sampler3D", "texture(t, vec3(0.1, 0.6, 0.9))", nearest(D3, false, [2, 2, 2]))[0], 6.0);
    assert_eq!(look("sampler1DArray", "texture(t, vec2(0.7, 1.4))", nearest(D1, true, [4, 1, 3]))[0], 6.0);
    assert_eq!(
        look("sampler2DArray", "texture(t, vec3(0.1, 0.1, 7.0))", nearest(SamplerDim::D2, true, [2, 2, 3]))[0],
        8.0
    );
    assert_eq!(look("sampler2DRect", "texture(t, vec2(2.5, 1.5))", nearest(Rect, false, [4, 2, 1]))[0], 6.0);
    assert_eq!(look("samplerBuffer", "texelFetch(t, 5)", nearest(Buffer, false, [8, 1, 1]))[0], 5.0);
    let faces = ["1,0,0", "-1,0,0", "0,1,0", "0,-1,0", "0,0,1", "0,0,-1"];
    for (face, direction) in faces.into_iter().enumerate() {
        let found = look("samplerCube", &format!("texture(t, vec3({direction}))"), nearest(Cube, false, [1, 1, 6]));
        assert_eq!(found[0], face as f64, "{direction}");
    }
    let edge = Texture { filter: Filter::Linear, ..nearest(Cube, false, [1, 1, 6]) };
    assert_eq!(
        look("samplerCube", "texture(t, vec3(1, 0, 1))", edge.clone())[0],
        2.0,
        "half of +X (0), half of +Z (4)"
    );
    assert_eq!(look("samplerCube", "texture(t, vec3(1, 1, 1))", edge)[0], 2.0, "a third of +X, +Y, +Z each");
}

#[test]
fn integer_texels_keep_their_bits() {
    let kind = SamplerType { texel: Scalar::Int, dim: SamplerDim::D2, arrayed: false, shadow: false };
    let level = TextureLevel { width: 1, height: 1, depth: 1, texels: Texels::Int(vec![[-5, 16_777_217, 0, 1]]) };
    let texture = Texture { kind, levels: vec![level], ..plane(Filter::Linear, Wrap::Repeat) };
    assert_eq!(look("isampler2D", "texture(t, vec2(0.5))", texture), [-5.0, 16_777_217.0, 0.0, 1.0]);
}

#[test]
fn shadow_samplers_compare_and_then_filter() {
    let kind = SamplerType { texel: Scalar::Float, dim: SamplerDim::D2, arrayed: false, shadow: true };
    let texels = Texels::Float([0.25, 0.75].map(|depth| [depth, 0.0, 0.0, 1.0]).into());
    let level = TextureLevel { width: 2, height: 1, depth: 1, texels };
    let texture = Texture { kind, levels: vec![level], ..plane(Filter::Linear, Wrap::ClampToEdge) };
    let at = |s: &str, depth: &str| {
        look("sampler2DShadow", &format!("texture(t, vec3({s}, 0.5, {depth}))"), texture.clone())[0]
    };
    assert_eq!([at("0.25", "0.5"), at("0.75", "0.5"), at("0.5", "0.5"), at("0.5", "0.1")], [0.0, 1.0, 0.5, 1.0]);
    assert_eq!(at("0.25", "0.25"), 1.0, "lequal");
}

#[test]
fn a_sampler_without_a_texture_gives_opaque_black() {
    let program = compiled("uniform sampler2D t; void main() { o = texture(t, vec2(0.5)); }");
    let machine = ran::<F64>(&program, &[None], |_, _| 0.0);
    assert_eq!(output(&program, &machine)[0], [0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn bounds_know_edges_between_texels() {
    let program =
        compiled("uniform sampler2D t; in float a; void main() { o = texture(t, vec2(a / 3.0 * 0.75, 0.25)); }");
    let found = |filter| {
        let machine = ran::<Envelope>(&program, &[Some(Arc::new(plane(filter, Wrap::ClampToEdge)))], |_, lane| {
            0.5 + lane as f64 * 0.5
        });
        output(&program, &machine)
    };
    // Lane 0 has a = 0.5. The edge between texels 0 and 1 is at s = 0.25, which is a = 1, in lane 1.
    let nearest = found(Filter::Nearest);
    assert_eq!(nearest[0][0].interval().width(), 0.0);
    assert_eq!(
        nearest[1][0].interval(),
        Interval { low: 0.0, high: 1.0, may_be_nan: false },
        "both texels and no more"
    );
    let linear = found(Filter::Linear);
    assert!(linear[1][0].error() > 0.003 && linear[1][0].error() < 0.05, "{:?}", linear[1][0]);
}
