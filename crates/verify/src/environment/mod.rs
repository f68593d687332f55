//! Environment maps for the module `environment`: light from all around, prefiltered for the microfacets of `ggx`.
//!
//! *In:* a panorama. *Out:* [`Prefiltered`], the radiance for each direction and roughness; nine coefficients of its irradiance
//! ([`coefficients`]); and how far all of it is from integrals over the panorama ([`errors()`]).
//!
//! ```text
//!  image ──► panorama   the light of each direction, and means over parts of it
//!        ──► prefilter  a map for each roughness, on an octahedron
//!        ──► harmonics  irradiance
//!        ──► errors     the lookups of the module against integrals in f64
//! ```
//!
//! *Holds:* all sums are in f64, and the same on every run. Nothing here reads or writes files.

pub mod errors;
mod harmonics;
mod lobe;
mod panorama;
mod prefilter;
mod split;

pub use errors::{Deviation, errors};
pub use harmonics::coefficients;
pub use panorama::Panorama;
pub use prefilter::Prefiltered;
pub use split::SplitSum;
