"""Parser of mathematics in LaTeX or plain notation. Formulas are translated into trees and never executed."""
