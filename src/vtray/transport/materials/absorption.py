"""stub"""
import math
from vtray.base.compiler.compiled import device
@device
def transmitted(absorption, distance):
    return (math.exp(-absorption[0]*distance) if absorption[0]>0 else 1.0, math.exp(-absorption[1]*distance) if absorption[1]>0 else 1.0, math.exp(-absorption[2]*distance) if absorption[2]>0 else 1.0)
