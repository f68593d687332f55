//! Determinants by permutations and inverses by elimination, which are not the executor's formulas.

use super::big::Big;
use super::oracle::{Want, near_sum};

/// The side of a square matrix with `count` scalars.
fn side(count: usize) -> usize {
    match count {
        4 => 2,
        9 => 3,
        _ => 4,
    }
}

/// The permutations of `0..n` with their signs.
fn permutations(n: usize) -> Vec<(Vec<usize>, f64)> {
    if n == 0 {
        return vec![(Vec::new(), 1.0)];
    }
    let mut all = Vec::new();
    for (shorter, sign) in permutations(n - 1) {
        for place in 0..n {
            let mut longer = shorter.clone();
            longer.insert(place, n - 1);
            // The last one moves before the `n - 1 - place` others.
            all.push((longer, if (n - 1 - place) % 2 == 1 { -sign } else { sign }));
        }
    }
    all
}

/// The determinant and the sum of its terms' absolute values.
fn leibniz(m: &[f64], n: usize) -> (Big, f64) {
    let mut sum = Big::of(0.0);
    let mut size = 0.0;
    for (permutation, sign) in permutations(n) {
        let factors = permutation.iter().enumerate().map(|(column, row)| m[column * n + row]);
        let term = factors.fold(Big::of(sign), |product, factor| &product * &Big::of(factor));
        size += term.approx().abs();
        sum = &sum + &term;
    }
    (sum, size)
}

pub(super) fn determinant(m: &[f64]) -> Want {
    let (value, terms) = leibniz(m, side(m.len()));
    near_sum(value, terms, 12.0)
}

/// Gauss-Jordan elimination with the largest pivot.
fn eliminate(m: &[f64], n: usize) -> Option<Vec<Big>> {
    // The rows of the matrix, followed by those of the identity matrix.
    let mut rows: Vec<Vec<Big>> = (0..n)
        .map(|row| {
            let left = (0..n).map(|column| Big::of(m[column * n + row]));
            left.chain((0..n).map(|column| Big::of(f64::from(u8::from(column == row))))).collect()
        })
        .collect();
    for pivot in 0..n {
        let best =
            (pivot..n).max_by(|&a, &b| rows[a][pivot].abs().approx().total_cmp(&rows[b][pivot].abs().approx()))?;
        rows.swap(pivot, best);
        if rows[pivot][pivot].is_zero() {
            return None;
        }
        let scale = rows[pivot][pivot].clone();
        let head: Vec<Big> = rows[pivot].iter().map(|value| value / &scale).collect();
        for (index, row) in rows.iter_mut().enumerate() {
            let factor = row[pivot].clone();
            if index == pivot {
                row.clone_from(&head);
            } else {
                row.iter_mut().zip(&head).for_each(|(value, head)| *value = &*value - &(&factor * head));
            }
        }
    }
    Some((0..n * n).map(|k| rows[k % n][n + k / n].clone()).collect())
}

pub(super) fn inverse(m: &[f64]) -> Vec<Want> {
    let n = side(m.len());
    let (determinant, terms) = leibniz(m, n);
    let determinant = determinant.approx().abs();
    // If the determinant is lost in its rounding, so is the inverse.
    let well = determinant > terms * 1e-10;
    let Some(inverse) = eliminate(m, n).filter(|_| well) else { return vec![Want::Anything; n * n] };
    // The error that elimination itself leaves in place of a 0.
    let noise = inverse.iter().map(|value| value.approx().abs()).fold(0.0, f64::max) * 1e-60;
    let wants = inverse.into_iter().enumerate().map(|(k, value)| {
        let (column, row) = (k / n, k % n);
        let rest: Vec<f64> = (0..n * n).filter(|at| at / n != row && at % n != column).map(|at| m[at]).collect();
        let (_, cofactor) = leibniz(&rest, n - 1);
        let size = noise + cofactor / determinant + value.approx().abs() * terms / determinant;
        near_sum(value, size, 16.0)
    });
    wants.collect()
}
