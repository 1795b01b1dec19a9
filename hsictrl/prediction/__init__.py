"""Recipes that predict the response to traffic; they differ where the paper's Table 1 says they differ."""

from hsictrl.prediction.assumptions import ASSUMPTIONS, Assumptions
from hsictrl.prediction.estimate import SpectralEstimate, spectral_estimate
from hsictrl.prediction.models import MODELS, Prediction, predict, predict_tuned, tune
from hsictrl.prediction.shared import check_alike, tuned_peaks

__all__ = ["ASSUMPTIONS", "MODELS", "Assumptions", "Prediction", "SpectralEstimate", "check_alike", "predict",
           "predict_tuned", "spectral_estimate", "tune", "tuned_peaks"]
