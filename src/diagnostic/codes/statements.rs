//! Codes of the phase `statements`; the table in the parent module says which range.

codes! {}
