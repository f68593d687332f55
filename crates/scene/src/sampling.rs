//! [`Sampling`]: what a texture's parameters have besides filter, wrap mode and comparison (OpenGL 3.2 §3.8).
//!
//! *In:* the keys of a scene's texture, or `texparameter` of a test. *Out:* the same for every runner. *Holds:* the default is
//! OpenGL's.

use crate::model::Filter;

/// Further parameters of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sampling {
    /// `TEXTURE_LOD_BIAS`, which is added to the level of detail (§3.8.11).
    pub lod_bias: f32,
    /// `TEXTURE_MAG_FILTER` if it is not the minification filter's within a level: whether it is linear.
    pub magnify_linear: Option<bool>,
    /// Whether a depth texture stores fixed-point numbers of 24 bits: a comparison's reference is then clamped to [0, 1]
    /// (§3.8.14).
    pub fixed_point_depth: bool,
}

impl Sampling {
    /// Whether magnification is linear for a filter.
    pub fn magnifies_linearly(&self, filter: Filter) -> bool {
        self.magnify_linear.unwrap_or(filter.is_linear())
    }

    /// Whether magnification and minification have different filters within a level.
    pub fn has_two_filters(&self, filter: Filter) -> bool {
        self.magnifies_linearly(filter) != filter.is_linear()
    }

    /// The level of detail up to which a texture is magnified: c of §3.8.12.
    pub fn magnified_up_to(&self, filter: Filter) -> f64 {
        let nearest_levels = matches!(filter, Filter::NearestMipmapNearest | Filter::NearestMipmapLinear);
        if nearest_levels && self.magnifies_linearly(filter) { 0.5 } else { 0.0 }
    }
}
