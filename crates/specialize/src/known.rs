//! [`Known`]: what a host fixes of a program, by the names of its reflection.
//!
//! *In:* values that stay the same for as long as a residual program is used. *Out:* nothing is computed here.
//! *Holds:* what is not named is not known. A value says what every draw with the residual has; a range says where all
//! values of all draws lie.

use glisten_front::hir::ScalarValue;
use std::collections::BTreeMap;

/// The inputs of a program that a host fixes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Known {
    /// Uniforms, named as in the reflection (`light[1].position`, `Block.member`): the scalars of the leaf, the elements of
    /// an array one after the other, matrices by columns.
    pub uniforms: BTreeMap<String, Vec<ScalarValue>>,
    /// Attributes: a scalar each of the declared type.
    pub attributes: BTreeMap<String, Vec<Input>>,
    /// Textures, by sampler.
    pub textures: BTreeMap<String, KnownTexture>,
    /// Fixed state.
    pub state: KnownState,
}

/// The part of a scalar from outside that is fixed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Input {
    /// It is always this.
    Value(ScalarValue),
    /// It is a finite `float` between two numbers, both included.
    Between(f32, f32),
    /// The same, and it is never -0.
    Unsigned(f32, f32),
    /// Nothing.
    Open,
}

/// The part of a texture that is fixed.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownTexture {
    /// Width, height and depth or layers of each level, as `textureSize` gives them; empty if they are not fixed.
    pub sizes: Vec<[u32; 3]>,
    /// The values that each channel of a lookup can have, filtered as it is. [`Input::Value`] is for textures of one color.
    pub channels: [Input; 4],
}

/// Fixed state. The default fixes nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KnownState {
    /// Whether primitives are points whose size the program sets; without it `gl_PointSize` is nobody's.
    pub point_size: Option<bool>,
    /// How many clip distances are enabled.
    pub clip_distances: Option<u32>,
    /// The value of `gl_FrontFacing`, where culling or the primitive decides it.
    pub front_facing: Option<bool>,
    /// How many color attachments there are: outputs beyond are nobody's.
    pub attachments: Option<u32>,
    /// Whether the formats of the color attachments have no -0, as those of 8 bits and of integers.
    pub unsigned_colors: bool,
    /// Whether the depth test is enabled; without it depth is not written either, and `gl_FragDepth` is nobody's.
    pub depth_test: Option<bool>,
    /// Width and height of the framebuffer in pixels.
    pub framebuffer: Option<[u32; 2]>,
    /// `gl_VertexID` is below this.
    pub vertices: Option<u32>,
    /// `gl_InstanceID` is below this.
    pub instances: Option<u32>,
    /// How far interpolated values may lie beyond the values at the vertices, in multiples of the distance between the least
    /// and the greatest of these. Nothing is known of interpolated values without it: a triangle that is thinner than the
    /// grid of positions may be interpolated far beyond its vertices.
    pub interpolation_reach: Option<f64>,
}
