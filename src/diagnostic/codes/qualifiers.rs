//! Codes of the phase `qualifiers`; the table in the parent module says which range.

codes! {}
