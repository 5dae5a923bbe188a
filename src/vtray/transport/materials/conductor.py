"""stub"""
import math
from vtray.base.compiler.compiled import device
@device
def _f(c, n, k):
    c=min(max(c,0.0),1.0)
    c2=c*c; s2=1-c2; e2=n*n; k2=k*k
    t0=e2-k2-s2; a2b2=math.sqrt(t0*t0+4*e2*k2); t1=a2b2+c2
    a=math.sqrt(max(0.5*(a2b2+t0),0.0)); t2=2*c*a
    rs=(t1-t2)/(t1+t2)
    t3=c2*a2b2+s2*s2; t4=t2*s2
    rp=rs*(t3-t4)/(t3+t4)
    return 0.5*(rs+rp)
@device
def conductor_shares(cosine, n, k):
    return _f(cosine,n[0],k[0]),_f(cosine,n[1],k[1]),_f(cosine,n[2],k[2])
