//! From the lights of a scene to those of the kernels.

use crate::geometry::Vec3;
use crate::lanes::elementary::sin_cos_degrees;
use crate::scene::Light;
use crate::stage::{LightSource, Spot};

/// Of a light that has been validated.
pub(super) fn compile(light: &Light) -> LightSource {
    let at_infinity = light.direction.is_some();
    let at: Vec3 = light.direction.or(light.position).unwrap_or_default().into();
    let spot = light.target.zip(light.cone).map(|(target, cone)| Spot {
        axis: (Vec3::from(target) - at).unit(),
        cos_end: sin_cos_degrees(cone).1,
        cos_full: sin_cos_degrees(cone - light.edge.unwrap_or(0.0)).1,
    });
    LightSource { at: if at_infinity { at.unit() } else { at }, at_infinity, color: light.color, spot }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;

    #[test]
    fn a_spot_light_fades_at_its_edge_only() {
        let light = |edge: Option<f64>| Light {
            name: None,
            position: Some([0.0, 3.0, 0.0]),
            direction: None,
            target: Some([0.0; 3]),
            cone: Some(60.0),
            edge,
            color: Rgb::gray(1.0),
        };
        let share = |edge: Option<f64>, degrees: f64| {
            let (sin, cos) = sin_cos_degrees(degrees);
            compile(&light(edge)).spot.map(|spot| spot.falloff::<f64>(Vec3::new(sin, cos, 0.0)))
        };
        assert_eq!(share(None, 59.9), Some(1.0));
        assert_eq!(share(None, 60.1), Some(0.0));
        assert_eq!(share(Some(30.0), 29.9), Some(1.0));
        assert_eq!(share(Some(30.0), 60.1), Some(0.0));
        assert_eq!(share(Some(60.0), 0.0), Some(1.0));
        // cos is halfway between those of 30 and 60 degrees: smoothstep gives a half.
        let half = libm::acos(f64::midpoint(sin_cos_degrees(30.0).1, 0.5)).to_degrees();
        assert!(share(Some(30.0), half).is_some_and(|s| (s - 0.5).abs() < 1e-14));
    }
}
