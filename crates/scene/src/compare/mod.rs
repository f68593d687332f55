//! The differences between two pictures.
//!
//! *In:* two [`Picture`](crate::picture::Picture)s of the same scene. *Out:* error figures and a [`Verdict`], which says
//! how much of the picture was judged ([`evidence`]).

pub mod evidence;
mod flip;
pub mod population;
mod tally;
mod verdict;
pub mod whole;

pub use evidence::{Class, Evidence, Written};
pub use flip::flip;
pub use population::Population;
pub use tally::{Compared, Comparison, shares};
pub use verdict::{Conclusion, Contributed, Criterion, Demands, FaultCount, Verdict, Worst, ulp_f32};
pub use whole::Gauge;
