"""Recipes that predict the response to traffic; they differ where the paper's Table 1 says they differ."""

from hsictrl.prediction.assumptions import ASSUMPTIONS, Assumptions
from hsictrl.prediction.estimate import SpectralEstimate, spectral_estimate
from hsictrl.prediction.models import MODELS, Prediction, predict, predict_tuned, tune

__all__ = ["ASSUMPTIONS", "MODELS", "Assumptions", "Prediction", "SpectralEstimate", "predict", "predict_tuned",
           "spectral_estimate", "tune"]
