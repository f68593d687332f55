//! Builds lookups, queries of textures, and the names of derivatives.

use super::expressions::Try;
use super::function::Builder;
use super::tree::Expr;
use naga::{Expression, Handle, ImageClass, ImageQuery, SampleLevel, TypeInner};
use std::borrow::Cow;

impl<'m> Builder<'m> {
    /// A lookup or a query.
    pub(super) fn lookup(&mut self, handle: Handle<Expression>) -> Try<Expr<'m>> {
        let function = self.function;
        let (name, operands): (Cow<'m, str>, Vec<Handle<Expression>>) = match &function.expressions[handle] {
            Expression::ImageQuery { image, query } => match query {
                ImageQuery::Size { level } => {
                    ("textureDimensions".into(), [*image].into_iter().chain(*level).collect())
                }
                ImageQuery::NumLevels => ("textureNumLevels".into(), vec![*image]),
                ImageQuery::NumLayers => ("textureNumLayers".into(), vec![*image]),
                ImageQuery::NumSamples => ("textureNumSamples".into(), vec![*image]),
            },
            Expression::ImageLoad { image, coordinate, array_index, sample, level } => {
                let operands = [*image, *coordinate].into_iter().chain(*array_index).chain(sample.or(*level));
                ("textureLoad".into(), operands.collect())
            }
            _ => return self.sample(handle),
        };
        let arguments = operands.into_iter().map(|operand| self.value(operand)).collect::<Try<Vec<_>>>()?;
        Ok(Expr::Call(name, arguments))
    }

    fn sample(&mut self, handle: Handle<Expression>) -> Try<Expr<'m>> {
        let function = self.function;
        let Expression::ImageSample {
            image, sampler, gather, coordinate, array_index, offset, level, depth_ref, ..
        } = &function.expressions[handle]
        else {
            return Err("a lookup was expected".to_owned());
        };
        let compare = if depth_ref.is_some() { "Compare" } else { "" };
        let mut arguments = Vec::new();
        let name = match gather {
            Some(component) => {
                let class = self.info[*image].ty.inner_with(&self.module.types);
                if !matches!(class, TypeInner::Image { class: ImageClass::Depth { .. }, .. }) {
                    arguments.push(Expr::Leaf((*component as u8).to_string().into()));
                }
                format!("textureGather{compare}")
            }
            None => {
                let level = match level {
                    SampleLevel::Auto => "",
                    SampleLevel::Zero | SampleLevel::Exact(_) => "Level",
                    SampleLevel::Bias(_) => "Bias",
                    SampleLevel::Gradient { .. } => "Grad",
                };
                format!("textureSample{compare}{level}")
            }
        };
        let levels: Vec<Handle<Expression>> = match (gather, level) {
            (None, SampleLevel::Exact(level) | SampleLevel::Bias(level)) => vec![*level],
            (None, SampleLevel::Gradient { x, y }) => vec![*x, *y],
            _ => Vec::new(),
        };
        let operands = [*image, *sampler, *coordinate].into_iter().chain(*array_index).chain(*depth_ref);
        for operand in operands {
            arguments.push(self.value(operand)?);
        }
        if gather.is_none() && matches!(level, SampleLevel::Zero) && depth_ref.is_none() {
            arguments.push(Expr::Leaf("0.0".into()));
        }
        for operand in levels.into_iter().chain(*offset) {
            arguments.push(self.value(operand)?);
        }
        Ok(Expr::Call(name.into(), arguments))
    }
}

/// The name of a derivative.
pub(super) fn derivative(axis: naga::DerivativeAxis, control: naga::DerivativeControl) -> String {
    let axis = match axis {
        naga::DerivativeAxis::X => "dpdx",
        naga::DerivativeAxis::Y => "dpdy",
        naga::DerivativeAxis::Width => "fwidth",
    };
    let control = match control {
        naga::DerivativeControl::Coarse => "Coarse",
        naga::DerivativeControl::Fine => "Fine",
        naga::DerivativeControl::None => "",
    };
    format!("{axis}{control}")
}
