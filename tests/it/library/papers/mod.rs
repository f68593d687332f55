//! Functions against closed forms that somebody wrote from the published sources without the modules at hand.
//!
//! *In:* `forms`, in the plainest form there is (angles, triangles, quadrature), and `points`, a thousand and more for each form, with
//! stiff ones among them. *Out:* where a function in f64 and its form are further apart than the constants of f32 in its text explain.
//! *Holds:* both get the same numbers: inputs are rounded to f32, and directions are of unit length after that.

mod forms;
mod points;

use self::forms::{V, unit};
use super::function;
use glisten_reference::Precision;

/// A call: its inputs, how many directions they begin with, and the results that the paper has for them.
type Case = (Vec<f64>, usize, Vec<f64>);

/// A direction as both sides get it.
fn rounded(d: V) -> V {
    unit(d.map(|x| f64::from(x as f32)))
}

fn f(x: f64) -> f64 {
    f64::from(x as f32)
}

/// The cases of which the paper's form says something.
fn cases<P>(points: Vec<P>, case: impl Fn(P) -> Option<Case>) -> Vec<Case> {
    points.into_iter().filter_map(case).collect()
}

fn lit(n: V, l: V, v: V) -> ([V; 3], Vec<f64>) {
    ([n, l, v].map(rounded), [n, l, v].concat())
}

/// Compares a function with its cases: `relative` of the result, and as much of 1.
#[track_caller]
fn compare(module: &str, signature: &str, cases: &[Case], relative: f64) {
    let n_directions = cases.first().map_or(0, |(_, n, _)| *n);
    let wraps: Vec<(usize, &str)> = (0..n_directions).map(|at| (at, "normalize")).collect();
    let rows: Vec<f32> = cases.iter().flat_map(|(inputs, ..)| inputs).map(|x| *x as f32).collect();
    let results = function(module, signature, &wraps).reference(&rows, &[], Precision::F64).expect("it is called");
    let mut wrong = Vec::new();
    for ((inputs, _, wanted), found) in cases.iter().zip(&results) {
        let far = found.iter().zip(wanted).map(|(found, wanted)| (found - wanted).abs() / (1.0 + wanted.abs()));
        let far = far.fold(0.0, |most: f64, far| if far <= most { most } else { far });
        // A NaN is far, too.
        if far.is_nan() || far > relative {
            wrong.push(format!("{inputs:?}: {found:?}, not {wanted:?}: {far:.2e}"));
        }
    }
    let n_wrong = wrong.len();
    wrong.truncate(8);
    assert!(cases.len() >= 1000, "{signature}: {} cases", cases.len());
    assert!(n_wrong == 0, "{signature}: {n_wrong} of {} cases\n{}", cases.len(), wrong.join("\n"));
}

/// A ball of glass: the direction in which the eye's ray leaves it, and how far it goes inside.
#[test]
fn balls_bend_light_as_the_law_of_refraction_says() {
    let ball = |(n, v, index): points::SpherePoint, of: &dyn Fn(V, V, f64) -> Vec<f64>| {
        let [up, eye] = [n, v].map(rounded);
        Some((vec![n[0], n[1], n[2], v[0], v[1], v[2], index], 2, of(up, eye, f(index))))
    };
    let exits = cases(points::sphere_points(), |point| ball(point, &|n, v, k| forms::sphere_exit(n, v, k).to_vec()));
    compare("transmission", "transmissionSphere(vec3,vec3,float)", &exits, 1e-7);
    let all = points::sphere_points().into_iter().chain(points::sphere_hidden_points()).collect();
    let paths = cases(all, |point| ball(point, &|n, v, k| vec![forms::sphere_path(n, v, k)]));
    compare("transmission", "transmissionPath(vec3,vec3,float)", &paths, 1e-7);
}

/// The Khronos sample renderer's blur by the index of refraction, and the indices of KHR_materials_dispersion; ours takes a dispersion of at
/// most 16, far above that of any glass.
#[test]
fn bodies_blur_and_spread_colors_as_khronos_says() {
    let blurs =
        cases(points::roughness_points(), |(r, n)| Some((vec![r, n], 0, vec![forms::blurred_roughness(f(r), f(n))])));
    compare("transmission", "transmissionRoughness(float,float)", &blurs, 1e-9);
    let spreads = cases(points::dispersion_points(), |(n, spread)| {
        let spread = spread.min(16.0);
        Some((vec![n, spread], 0, forms::dispersed(f(n), f(spread)).to_vec()))
    });
    compare("transmission", "transmissionIndices(float,float)", &spreads, 1e-9);
}

/// The reference code of EON where it is a number, and our own form of it: its fit of the albedo is within 1e-3 (the paper has 0.1 %).
#[test]
fn the_naive_eon_is_the_papers() {
    let albedos = cases(points::albedo_points(), |(mu, r)| {
        // At a cosine of 1e-6, (1 - s^3) / mu of the listing has few digits in f64 either.
        let cosine = f(mu);
        (cosine >= 1e-5).then(|| (vec![mu, r], 0, vec![forms::eon_albedo(cosine, f(r))]))
    });
    compare("naive", "naiveEonExact(float,float)", &albedos, 1e-7);
    let eon = |(n, l, v, rho, r): points::EonPoint| {
        let ([up, light, eye], mut inputs) = lit(n, l, v);
        inputs.extend(rho);
        inputs.push(r);
        let wanted = forms::eon(up, light, eye, rho.map(f), f(r))?;
        Some((inputs, 3, wanted.to_vec()))
    };
    let all = cases(points::eon_points(), eon);
    compare("oren_nayar", "eonFactor(vec3,vec3,vec3,vec3,float)", &all, 1e-3);
    // The listing takes the root of 1 - cos^2, which is negative where rounding makes a cosine larger than 1: NaN, which its floor of 1e-7
    // turns into a loss. That is its fault (`faults`), and not that of the transcription.
    let is_upright = |d: V, n: V| d.iter().zip(n).all(|(d, n)| (d - n).abs() < 1e-6);
    let tilted: Vec<_> =
        points::eon_points().into_iter().filter(|(n, l, v, ..)| !is_upright(*l, *n) && !is_upright(*v, *n)).collect();
    compare("naive", "naiveEon(vec3,vec3,vec3,vec3,float)", &cases(tilted, eon), 2e-7);
}

/// The albedo that the paper has in closed form is the integral of its factor.
#[test]
fn the_papers_albedo_is_its_integral() {
    for (mu, r) in points::albedo_points().into_iter().step_by(40) {
        let (closed, integral) = (forms::eon_albedo(mu, r), forms::eon_albedo_integral(mu, r));
        assert!((closed - integral).abs() < 1e-10, "{mu} {r}: {closed} {integral}");
    }
}

/// three.js' direct light on plastic and on velvet, with its floors.
#[test]
fn the_naive_plastic_and_sheen_are_those_of_three_js() {
    let plastic = |(n, l, v, diffuse, f0, alpha): points::PlasticPoint| {
        let ([up, light, eye], mut inputs) = lit(n, l, v);
        inputs.extend(diffuse);
        inputs.extend([f0, alpha]);
        let wanted = forms::three_plastic(up, light, eye, diffuse.map(f), f(f0), f(alpha))?;
        Some((inputs, 3, wanted.to_vec()))
    };
    compare("naive", "naivePlastic(vec3,vec3,vec3,vec3,float,float)", &cases(points::plastic_points(), plastic), 1e-6);
    let sheen = |(n, l, v, alpha): points::SheenPoint| {
        let ([up, light, eye], mut inputs) = lit(n, l, v);
        inputs.push(alpha);
        Some((inputs, 3, vec![forms::three_sheen(up, light, eye, f(alpha))?]))
    };
    compare("naive", "naiveSheen(vec3,vec3,vec3,float)", &cases(points::sheen_points(), sheen), 1e-6);
}
