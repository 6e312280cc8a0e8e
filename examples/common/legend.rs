//! The legend of the examples that draw.

use plotters::coord::CoordTranslate;
use plotters::prelude::*;

/// Draws the legend of all series with a label.
pub fn legend<'a, DB: DrawingBackend + 'a, CT: CoordTranslate>(
    chart: &mut ChartContext<'a, DB, CT>,
    position: SeriesLabelPosition,
) -> Result<(), DrawingAreaErrorKind<DB::ErrorType>> {
    let mut labels = chart.configure_series_labels();
    labels.position(position).background_style(WHITE.mix(0.9)).border_style(BLACK);
    labels.label_font(("sans-serif", 15)).legend_area_size(30).draw()
}
