//! Discharge of grains through a slot in the floor of a silo.
//!
//! Beverloo, Leniger and van de Velde (1961), in the plane: what flows out does not depend on how high the fill is, since grains fall
//! freely from an arch over the opening that is as high as this is wide. Staron, Lagrée and Popinet (2012) find the same for a
//! continuum with friction.

/// Discharge per thickness, kg/(s m): C rho sqrt(g) (D - k)^(3/2), for a coefficient, a density (kg/m3), gravity (m/s2), the width of
/// the slot (m) and by how much that is narrower for the flow (m).
pub fn beverloo(coefficient: f64, density: f64, gravity: f64, width: f64, lost: f64) -> f64 {
    coefficient * density * gravity.sqrt() * libm::pow((width - lost).max(0.0), 1.5)
}

/// The coefficient C of a discharge per thickness (kg/(s m)) if nothing of the width is lost.
pub fn coefficient(discharge: f64, density: f64, gravity: f64, width: f64) -> f64 {
    discharge / beverloo(1.0, density, gravity, width, 0.0)
}

/// What two grids lose of the width of a slot, in their cells, if they lose the same: from the coefficient without loss on so many
/// cells over the width and the one on twice as many.
pub fn lost_cells(cells: f64, coarse: f64, fine: f64) -> f64 {
    let [coarse, fine] = [coarse, fine].map(|c| libm::pow(c, 2.0 / 3.0));
    // (C'/C)^(2/3) = 1 - k/n on either grid.
    2.0 * cells * (fine - coarse) / (2.0 * fine - coarse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slot_of_eighty_millimetres() {
        // By hand: 1.4 x 1500 x 3.132092 x 0.0226274 = 148.83.
        let discharge = beverloo(1.4, 1500.0, 9.81, 0.08, 0.0);
        assert!((discharge - 148.83).abs() < 0.01, "{discharge}");
        assert!((coefficient(discharge, 1500.0, 9.81, 0.08) - 1.4).abs() < 1e-12);
        assert_eq!(beverloo(1.4, 1500.0, 9.81, 0.08, 0.09), 0.0);
    }

    #[test]
    fn the_loss_comes_back() {
        for lost in [-0.3, 0.0, 1.7] {
            let on = |cells: f64| coefficient(beverloo(1.4, 1.0, 1.0, 1.0, lost / cells), 1.0, 1.0, 1.0);
            assert!((lost_cells(8.0, on(8.0), on(16.0)) - lost).abs() < 1e-12);
        }
    }
}
