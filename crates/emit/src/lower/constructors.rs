//! Lowers constructors (§5.4), given in the normal forms of [`ConstructKind`].

use super::Try;
use super::function::Ctx;
use glisten_front::hir::{ConstructKind, ExprId, Scalar, Swizzle, Type, TypeId};
use naga::{Expression, Handle};

/// The components of a scalar or vector that have not been used yet.
struct Piece {
    value: Handle<Expression>,
    size: u8,
    used: u8,
}

impl Ctx<'_, '_> {
    /// A constructor call.
    pub(super) fn construct(
        &mut self,
        kind: ConstructKind,
        arguments: &[ExprId],
        ty: TypeId,
    ) -> Try<Handle<Expression>> {
        let mut values = Vec::with_capacity(arguments.len());
        for argument in arguments {
            values.push((self.value(*argument)?, self.shader.expr(*argument).ty));
        }
        let first = values.first().copied();
        match (kind, first) {
            (ConstructKind::Splat, Some((value, _))) => {
                let size = self.size_of(ty);
                Ok(self.splat(value, size))
            }
            (ConstructKind::Diagonal, Some((value, _))) => self.diagonal(value, ty),
            (ConstructKind::Resize, Some((value, from))) => self.resize(value, from, ty),
            (ConstructKind::Compose, Some(_)) => self.compose(&values, ty),
            (ConstructKind::Array | ConstructKind::Struct, _) => {
                let components = values.into_iter().map(|(value, _)| value).collect();
                let ty = self.low.value_type(ty)?;
                Ok(self.add(Expression::Compose { ty, components }))
            }
            (_, None) => Err(self.internal_error("a constructor without arguments")),
        }
    }

    /// `mat3(x)`
    fn diagonal(&mut self, value: Handle<Expression>, ty: TypeId) -> Try<Handle<Expression>> {
        let Type::Matrix(columns, rows) = self.low.types.get(ty) else {
            return Err(self.internal_error("a matrix was expected"));
        };
        let zero = self.float(0.0);
        let column_ty = self.low.vector_type(Scalar::Float, rows);
        let mut components = Vec::new();
        for column in 0..columns {
            let entries = (0..rows).map(|row| if row == column { value } else { zero }).collect();
            components.push(self.add(Expression::Compose { ty: column_ty, components: entries }));
        }
        let ty = self.low.value_type(ty)?;
        Ok(self.add(Expression::Compose { ty, components }))
    }

    /// `mat3(m)`: takes the upper left of `m`, and the rest from the identity.
    fn resize(&mut self, value: Handle<Expression>, from: TypeId, ty: TypeId) -> Try<Handle<Expression>> {
        let (Type::Matrix(columns, rows), Type::Matrix(_, from_rows)) =
            (self.low.types.get(ty), self.low.types.get(from))
        else {
            return Err(self.internal_error("a matrix was expected"));
        };
        if from == ty {
            return Ok(value);
        }
        let (_, given) = self.columns(value, from)?;
        let column_ty = self.low.vector_type(Scalar::Float, rows);
        let mut components = Vec::new();
        for column in 0..columns {
            let present = given.get(usize::from(column)).copied();
            components.push(match present {
                Some(present) if from_rows == rows => present,
                Some(present) if from_rows > rows => self.first_components(present, rows),
                _ => {
                    let have = if present.is_some() { from_rows } else { 0 };
                    let mut entries: Vec<_> = present.into_iter().collect();
                    entries.extend((have..rows).map(|row| self.float(if row == column { 1.0 } else { 0.0 })));
                    self.add(Expression::Compose { ty: column_ty, components: entries })
                }
            });
        }
        let ty = self.low.value_type(ty)?;
        Ok(self.add(Expression::Compose { ty, components }))
    }

    /// A vector or matrix from the components of its arguments in order.
    fn compose(&mut self, values: &[(Handle<Expression>, TypeId)], ty: TypeId) -> Try<Handle<Expression>> {
        let mut pieces = Vec::new();
        for (value, from) in values {
            if let Type::Matrix(..) = self.low.types.get(*from) {
                let (column_ty, columns) = self.columns(*value, *from)?;
                let size = self.size_of(column_ty);
                pieces.extend(columns.into_iter().map(|value| Piece { value, size, used: 0 }));
            } else {
                pieces.push(Piece { value: *value, size: self.size_of(*from), used: 0 });
            }
        }
        let mut pieces = pieces.into_iter();
        let mut open = pieces.next();
        let scalar = self.low.types.scalar_of(ty).unwrap_or(Scalar::Float);
        let (columns, size) = match self.low.types.get(ty) {
            Type::Matrix(columns, rows) => (columns, rows),
            Type::Vector(_, size) => (1, size),
            _ => (1, 1),
        };
        let mut lines = Vec::new();
        for _ in 0..columns {
            let mut parts = Vec::new();
            let mut missing = size;
            while missing > 0 {
                let Some(piece) = &mut open else { return Err(self.internal_error("a constructor lacks components")) };
                let taken = missing.min(piece.size - piece.used);
                parts.push(self.part(piece, taken));
                missing -= taken;
                piece.used += taken;
                if piece.used == piece.size {
                    open = pieces.next();
                }
            }
            lines.push(self.join(parts, scalar, size));
        }
        if columns == 1 {
            return lines.first().copied().ok_or_else(|| self.internal_error("a constructor without components"));
        }
        let ty = self.low.value_type(ty)?;
        Ok(self.add(Expression::Compose { ty, components: lines }))
    }

    fn part(&mut self, piece: &Piece, len: u8) -> Handle<Expression> {
        if len == piece.size {
            return piece.value;
        }
        let mut components = [0; 4];
        for (to, from) in components.iter_mut().take(usize::from(len)).zip(piece.used..) {
            *to = from;
        }
        self.swizzled(piece.value, Swizzle { len, components })
    }

    fn join(&mut self, parts: Vec<Handle<Expression>>, scalar: Scalar, size: u8) -> Handle<Expression> {
        match parts.as_slice() {
            [one] => *one,
            _ => {
                let ty = self.low.vector_type(scalar, size);
                self.add(Expression::Compose { ty, components: parts })
            }
        }
    }
}
