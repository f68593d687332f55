//! The rules, one file each. This list is made from the folder and the table of codes:
//! `UPDATE_RULES=1 cargo test -p glisten-front every_rule_is_listed`.

mod acos_beyond_one;
mod assignment_in_condition;
mod beyond_webgl;
mod bool_literal_selection;
mod clamp_by_min_max;
mod comparison_chain;
mod constant_condition;
mod depth_written;
mod divergent_derivative;
mod division_by_clamped_zero;
mod empty_body;
mod flat_provoking_vertex;
mod float_equality;
mod float_loop_counter;
mod frag_coord_row;
mod identical_branches;
mod identity_operation;
mod infinite_loop;
mod initialized_uniform;
mod integer_division;
mod integer_division_by_zero;
mod interpolated_normal;
mod late_discard;
mod legacy_lookup;
mod legacy_output;
mod legacy_qualifier;
mod length_of_difference;
mod log_of_zero;
mod loop_counts_away;
mod loop_invariant_call;
mod loop_invariant_lookup;
mod matrix_inverse;
mod maybe_uninitialized_read;
mod missing_default;
mod mix_by_bool;
mod non_finite_constant;
mod normal_by_model_matrix;
mod normalize_of_zero;
mod point_size;
mod position_not_written;
mod pow_maybe_negative;
mod pow_of_negative;
mod pow_of_two;
mod repeated_call;
mod repeated_macro;
mod return_on_some_ways;
mod reversed_bounds;
mod self_assignment;
mod self_comparison;
mod shadowed_builtin;
mod shadowed_variable;
mod sqrt_maybe_negative;
mod std140_padding;
mod uniform_branch;
mod uniform_work;
mod uninitialized_read;
mod unnormalized_direction;
mod unreachable_code;
mod unused_allow;
mod unused_attribute;
mod unused_function;
mod unused_include;
mod unused_input;
mod unused_macro;
mod unused_parameter;
mod unused_struct;
mod unused_uniform;
mod unused_variable;
mod unused_varying;
mod unwritten_out_parameter;
mod unwritten_output;
mod unwritten_varying;
mod value_dropped;
mod vertex_work;
mod webgpu_limits;
mod wgsl_reserved_name;

use super::Rule;
use crate::diagnostic::codes::lints;

pub(super) static RULES: &[Rule] = &[
    Rule { code: &lints::UNUSED_VARYING, check: unused_varying::check },
    Rule { code: &lints::UNWRITTEN_OUTPUT, check: unwritten_output::check },
    Rule { code: &lints::POSITION_NOT_WRITTEN, check: position_not_written::check },
    Rule { code: &lints::FLAT_PROVOKING_VERTEX, check: flat_provoking_vertex::check },
    Rule { code: &lints::UNINITIALIZED_READ, check: uninitialized_read::check },
    Rule { code: &lints::UNWRITTEN_OUT_PARAMETER, check: unwritten_out_parameter::check },
    Rule { code: &lints::NON_FINITE_CONSTANT, check: non_finite_constant::check },
    Rule { code: &lints::INTEGER_DIVISION_BY_ZERO, check: integer_division_by_zero::check },
    Rule { code: &lints::POW_OF_NEGATIVE, check: pow_of_negative::check },
    Rule { code: &lints::DIVERGENT_DERIVATIVE, check: divergent_derivative::check },
    Rule { code: &lints::INFINITE_LOOP, check: infinite_loop::check },
    Rule { code: &lints::UNREACHABLE_CODE, check: unreachable_code::check },
    Rule { code: &lints::RETURN_ON_SOME_WAYS, check: return_on_some_ways::check },
    Rule { code: &lints::UNWRITTEN_VARYING, check: unwritten_varying::check },
    Rule { code: &lints::MAYBE_UNINITIALIZED_READ, check: maybe_uninitialized_read::check },
    Rule { code: &lints::ASSIGNMENT_IN_CONDITION, check: assignment_in_condition::check },
    Rule { code: &lints::LOOP_COUNTS_AWAY, check: loop_counts_away::check },
    Rule { code: &lints::SELF_ASSIGNMENT, check: self_assignment::check },
    Rule { code: &lints::IDENTICAL_BRANCHES, check: identical_branches::check },
    Rule { code: &lints::EMPTY_BODY, check: empty_body::check },
    Rule { code: &lints::COMPARISON_CHAIN, check: comparison_chain::check },
    Rule { code: &lints::CONSTANT_CONDITION, check: constant_condition::check },
    Rule { code: &lints::INTEGER_DIVISION, check: integer_division::check },
    Rule { code: &lints::MISSING_DEFAULT, check: missing_default::check },
    Rule { code: &lints::SELF_COMPARISON, check: self_comparison::check },
    Rule { code: &lints::FLOAT_EQUALITY, check: float_equality::check },
    Rule { code: &lints::FLOAT_LOOP_COUNTER, check: float_loop_counter::check },
    Rule { code: &lints::POW_MAYBE_NEGATIVE, check: pow_maybe_negative::check },
    Rule { code: &lints::SQRT_MAYBE_NEGATIVE, check: sqrt_maybe_negative::check },
    Rule { code: &lints::ACOS_BEYOND_ONE, check: acos_beyond_one::check },
    Rule { code: &lints::LOG_OF_ZERO, check: log_of_zero::check },
    Rule { code: &lints::DIVISION_BY_CLAMPED_ZERO, check: division_by_clamped_zero::check },
    Rule { code: &lints::NORMALIZE_OF_ZERO, check: normalize_of_zero::check },
    Rule { code: &lints::INTERPOLATED_NORMAL, check: interpolated_normal::check },
    Rule { code: &lints::UNNORMALIZED_DIRECTION, check: unnormalized_direction::check },
    Rule { code: &lints::NORMAL_BY_MODEL_MATRIX, check: normal_by_model_matrix::check },
    Rule { code: &lints::LOOP_INVARIANT_LOOKUP, check: loop_invariant_lookup::check },
    Rule { code: &lints::LOOP_INVARIANT_CALL, check: loop_invariant_call::check },
    Rule { code: &lints::UNIFORM_WORK, check: uniform_work::check },
    Rule { code: &lints::MATRIX_INVERSE, check: matrix_inverse::check },
    Rule { code: &lints::VERTEX_WORK, check: vertex_work::check },
    Rule { code: &lints::UNIFORM_BRANCH, check: uniform_branch::check },
    Rule { code: &lints::LATE_DISCARD, check: late_discard::check },
    Rule { code: &lints::DEPTH_WRITTEN, check: depth_written::check },
    Rule { code: &lints::FRAG_COORD_ROW, check: frag_coord_row::check },
    Rule { code: &lints::POINT_SIZE, check: point_size::check },
    Rule { code: &lints::WEBGPU_LIMITS, check: webgpu_limits::check },
    Rule { code: &lints::WGSL_RESERVED_NAME, check: wgsl_reserved_name::check },
    Rule { code: &lints::STD140_PADDING, check: std140_padding::check },
    Rule { code: &lints::INITIALIZED_UNIFORM, check: initialized_uniform::check },
    Rule { code: &lints::UNUSED_VARIABLE, check: unused_variable::check },
    Rule { code: &lints::UNUSED_PARAMETER, check: unused_parameter::check },
    Rule { code: &lints::UNUSED_FUNCTION, check: unused_function::check },
    Rule { code: &lints::UNUSED_ATTRIBUTE, check: unused_attribute::check },
    Rule { code: &lints::UNUSED_UNIFORM, check: unused_uniform::check },
    Rule { code: &lints::UNUSED_INPUT, check: unused_input::check },
    Rule { code: &lints::UNUSED_STRUCT, check: unused_struct::check },
    Rule { code: &lints::UNUSED_MACRO, check: unused_macro::check },
    Rule { code: &lints::UNUSED_INCLUDE, check: unused_include::check },
    Rule { code: &lints::POW_OF_TWO, check: pow_of_two::check },
    Rule { code: &lints::LENGTH_OF_DIFFERENCE, check: length_of_difference::check },
    Rule { code: &lints::IDENTITY_OPERATION, check: identity_operation::check },
    Rule { code: &lints::CLAMP_BY_MIN_MAX, check: clamp_by_min_max::check },
    Rule { code: &lints::MIX_BY_BOOL, check: mix_by_bool::check },
    Rule { code: &lints::BOOL_LITERAL_SELECTION, check: bool_literal_selection::check },
    Rule { code: &lints::REPEATED_MACRO, check: repeated_macro::check },
    Rule { code: &lints::REPEATED_CALL, check: repeated_call::check },
    Rule { code: &lints::SHADOWED_VARIABLE, check: shadowed_variable::check },
    Rule { code: &lints::SHADOWED_BUILTIN, check: shadowed_builtin::check },
    Rule { code: &lints::LEGACY_LOOKUP, check: legacy_lookup::check },
    Rule { code: &lints::LEGACY_QUALIFIER, check: legacy_qualifier::check },
    Rule { code: &lints::LEGACY_OUTPUT, check: legacy_output::check },
    Rule { code: &lints::UNUSED_ALLOW, check: unused_allow::check },
    Rule { code: &lints::REVERSED_BOUNDS, check: reversed_bounds::check },
    Rule { code: &lints::BEYOND_WEBGL, check: beyond_webgl::check },
    Rule { code: &lints::VALUE_DROPPED, check: value_dropped::check },
];
