"""The sections of yarns, and the splines they are drawn with."""

from .flat import Flat
from .forms import register
from .lenticular import Lenticular
from .round import Round

for _form in (Lenticular(), Flat(), Round()):  # in the order in which messages tell them
    register(_form)
