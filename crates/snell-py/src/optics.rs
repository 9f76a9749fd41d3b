//! The library's formulas on columns of numbers, which Python has made equally long. Angles are in degrees, as everywhere in
//! Python; what does not exist is NaN.

use crate::errors::raise;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use snell::geometry::Vec3;
use snell::lanes::elementary::sin_cos_degrees;
use snell::optics::glass::{self, Glass};
use snell::optics::{fresnel as face, snell as law, thin};

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(refract, module)?)?;
    module.add_function(wrap_pyfunction!(reflect, module)?)?;
    module.add_function(wrap_pyfunction!(fresnel, module)?)?;
    module.add_function(wrap_pyfunction!(critical_angle, module)?)?;
    module.add_function(wrap_pyfunction!(brewster_angle, module)?)?;
    module.add_function(wrap_pyfunction!(slab_offset, module)?)?;
    module.add_function(wrap_pyfunction!(glass_names, module)?)?;
    module.add_class::<NativeGlass>()
}

type Column<'py> = PyReadonlyArray1<'py, f64>;
type Vectors<'py> = PyReadonlyArray2<'py, f64>;

fn vectors(rows: &Vectors<'_>) -> impl Iterator<Item = Vec3> {
    rows.as_array().rows().into_iter().map(|row| Vec3::new(row[0], row[1], row[2])).collect::<Vec<_>>().into_iter()
}

fn vectors_out(py: Python<'_>, rows: impl Iterator<Item = Vec3>) -> Bound<'_, PyArray2<f64>> {
    let rows: Vec<[f64; 3]> = rows.map(Vec3::into).collect();
    PyArray2::from_owned_array(py, rows.into())
}

fn numbers(column: &Column<'_>) -> Vec<f64> {
    column.as_array().to_vec()
}

fn cosine(degrees: f64) -> f64 {
    sin_cos_degrees(degrees).1
}

fn zipped<const N: usize>(columns: [Column<'_>; N], f: impl Fn([f64; N]) -> f64) -> Vec<f64> {
    let columns = columns.map(|column| numbers(&column));
    let count = columns.iter().map(Vec::len).min().unwrap_or(0);
    (0..count).map(|i| f(std::array::from_fn(|column| columns[column][i]))).collect()
}

/// `wo`, `n` and `mu` to the refracted directions.
#[pyfunction]
fn refract<'py>(py: Python<'py>, wo: Vectors<'py>, n: Vectors<'py>, mu: Column<'py>) -> Bound<'py, PyArray2<f64>> {
    let rows = vectors(&wo).zip(vectors(&n)).zip(numbers(&mu)).map(|((wo, n), mu)| {
        let (wi, exists) = law::refract(wo, n, mu);
        if exists { wi } else { Vec3::new(f64::NAN, f64::NAN, f64::NAN) }
    });
    vectors_out(py, rows)
}

/// `wo` and `n` to the mirrored directions.
#[pyfunction]
fn reflect<'py>(py: Python<'py>, wo: Vectors<'py>, n: Vectors<'py>) -> Bound<'py, PyArray2<f64>> {
    vectors_out(py, vectors(&wo).zip(vectors(&n)).map(|(wo, n)| law::reflect(wo, n)))
}

/// Reflectance by angle and relative index.
#[pyfunction]
fn fresnel<'py>(py: Python<'py>, theta_i: Column<'py>, eta: Column<'py>) -> Bound<'py, PyArray1<f64>> {
    let reflectance = |[theta, eta]: [f64; 2]| face::fresnel_dielectric(cosine(theta), eta);
    PyArray1::from_vec(py, zipped([theta_i, eta], reflectance))
}

/// Angles from which on nothing is refracted.
#[pyfunction]
fn critical_angle<'py>(py: Python<'py>, eta: Column<'py>) -> Bound<'py, PyArray1<f64>> {
    let angle = |[eta]: [f64; 1]| face::critical_angle(eta).map_or(f64::NAN, f64::to_degrees);
    PyArray1::from_vec(py, zipped([eta], angle))
}

/// Angles at which what swings in the plane of incidence is not reflected.
#[pyfunction]
fn brewster_angle<'py>(py: Python<'py>, eta: Column<'py>) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_vec(py, zipped([eta], |[eta]| face::brewster_angle(eta).to_degrees()))
}

/// How far aside a pane moves a ray, by thickness, angle and relative index.
#[pyfunction]
fn slab_offset<'py>(
    py: Python<'py>,
    thickness: Column<'py>,
    theta_i: Column<'py>,
    eta: Column<'py>,
) -> Bound<'py, PyArray1<f64>> {
    let offset = |[thickness, theta, eta]: [f64; 3]| {
        let c = cosine(theta);
        // The formula holds only where something goes through.
        if face::cos_theta_t(c, eta) > 0.0 { thin::lateral_displacement(thickness, c, eta) } else { f64::NAN }
    };
    PyArray1::from_vec(py, zipped([thickness, theta_i, eta], offset))
}

/// All glasses of the catalogue.
#[pyfunction]
fn glass_names() -> Vec<&'static str> {
    glass::CATALOGUE.iter().map(|glass| glass.name).collect()
}

/// A glass of the catalogue.
#[pyclass(frozen)]
pub struct NativeGlass(&'static Glass);

#[pymethods]
impl NativeGlass {
    #[new]
    fn new(py: Python<'_>, name: &str) -> PyResult<Self> {
        glass::find(name).map(Self).map_err(|error| raise(py, "OpticsError", vec![(None, error.to_string(), None)]))
    }

    #[getter]
    fn name(&self) -> &'static str {
        self.0.name
    }

    #[getter]
    fn source(&self) -> &'static str {
        self.0.source
    }

    #[getter]
    fn range_nm(&self) -> (f64, f64) {
        self.0.dispersion.range_nm.into()
    }

    #[getter]
    fn abbe_number(&self) -> Option<f64> {
        self.0.dispersion.abbe_number().ok()
    }

    /// Indices by wavelength.
    fn eta<'py>(&self, py: Python<'py>, wavelength_nm: Column<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let eta: Result<Vec<f64>, _> =
            numbers(&wavelength_nm).into_iter().map(|nm| self.0.dispersion.eta(nm)).collect();
        eta.map(|eta| PyArray1::from_vec(py, eta))
            .map_err(|error| raise(py, "OpticsError", vec![(None, error.to_string(), None)]))
    }
}
