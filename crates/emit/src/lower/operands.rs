//! The operands of a naga expression, which naga does not make public.

use naga::{Expression, Handle, SampleLevel};

/// Calls `visit` with each operand.
pub(crate) fn for_each_operand(expression: &Expression, mut visit: impl FnMut(Handle<Expression>)) {
    match *expression {
        Expression::Compose { ref components, .. } => components.iter().for_each(|&component| visit(component)),
        Expression::Access { base, index } => {
            visit(base);
            visit(index);
        }
        Expression::AccessIndex { base, .. } => visit(base),
        Expression::Splat { value, .. } => visit(value),
        Expression::Swizzle { vector, .. } => visit(vector),
        Expression::Load { pointer } => visit(pointer),
        Expression::ImageSample { image, sampler, coordinate, array_index, offset, level, depth_ref, .. } => {
            visit(image);
            visit(sampler);
            visit(coordinate);
            array_index.into_iter().chain(offset).chain(depth_ref).for_each(&mut visit);
            sample_level(level, visit);
        }
        Expression::ImageLoad { image, coordinate, array_index, sample, level } => {
            visit(image);
            visit(coordinate);
            array_index.into_iter().chain(sample).chain(level).for_each(visit);
        }
        Expression::ImageQuery { image, query } => {
            visit(image);
            if let naga::ImageQuery::Size { level: Some(level) } = query {
                visit(level);
            }
        }
        Expression::Unary { expr, .. } | Expression::As { expr, .. } | Expression::Derivative { expr, .. } => {
            visit(expr);
        }
        Expression::Binary { left, right, .. } => {
            visit(left);
            visit(right);
        }
        Expression::Select { condition, accept, reject } => {
            visit(condition);
            visit(accept);
            visit(reject);
        }
        Expression::Relational { argument, .. } => visit(argument),
        Expression::Math { arg, arg1, arg2, arg3, .. } => {
            visit(arg);
            arg1.into_iter().chain(arg2).chain(arg3).for_each(visit);
        }
        // The other expressions have no operands, or are never created here.
        _ => {}
    }
}

fn sample_level(level: SampleLevel, mut visit: impl FnMut(Handle<Expression>)) {
    match level {
        SampleLevel::Auto | SampleLevel::Zero => {}
        SampleLevel::Exact(level) | SampleLevel::Bias(level) => visit(level),
        SampleLevel::Gradient { x, y } => {
            visit(x);
            visit(y);
        }
    }
}
