//! Codes of the phase `preprocess`; the table in the parent module says which range.

codes! {}
